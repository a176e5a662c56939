// gridrt_mailbox: requests, answers that come too late, input reports.
#include <random>

#include <Vgridrt_mailbox.h>
#include <gtest/gtest.h>

#include "gridrt_firmware_protocol.hpp"
#include "tests/rtl/clocked.hpp"

namespace gridrt::rtl {
namespace {

namespace reg = wire::registers;

class Mailbox {
 public:
  Mailbox() {
    pins_->request_valid_i = pins_->body_write_i = pins_->event_taken_i = 0;
    pins_->select_i = pins_->write_i = 0;
    pins_.reset();
  }
  Vgridrt_mailbox* operator->() { return pins_.operator->(); }
  void tick() { pins_.tick(); }
  void settle() { pins_.settle(); }

  std::uint32_t read(std::uint32_t address) {
    access(address, false, 0);
    const std::uint32_t data = pins_->read_data_o;
    release();
    return data;
  }
  /// Returns whether the USB side saw an answer in that clock.
  bool write(std::uint32_t address, std::uint32_t data) {
    access(address, true, data);
    const bool answer = pins_->answer_valid_o != 0;
    good_ = pins_->answer_good_o != 0;
    length_ = pins_->answer_length_o;
    release();
    return answer;
  }
  bool answer(std::uint32_t tag, bool good, std::uint32_t length) {
    return write(reg::Mailbox::kAnswer, tag << reg::Mailbox::kAnswerTagBit |
                                            length << reg::Mailbox::kAnswerLengthBit |
                                            (good ? 1U : 0U) << reg::Mailbox::kAnswerGoodBit);
  }
  [[nodiscard]] bool good() const { return good_; }
  [[nodiscard]] std::uint32_t length() const { return length_; }

  void ask(bool set, std::uint8_t id, std::uint8_t length) {
    pins_->request_valid_i = 1;
    pins_->request_set_i = set ? 1 : 0;
    pins_->request_id_i = id;
    pins_->request_length_i = length;
    tick();
  }
  void withdraw() {
    pins_->request_valid_i = 0;
    tick();
  }
  std::uint32_t tag() {
    return read(reg::Mailbox::kRequest) >> reg::Mailbox::kRequestTagBit &
           reg::Mailbox::kRequestTagMask;
  }
  bool asked() { return read(reg::Mailbox::kRequest) >> 31U != 0; }

  void put(std::uint8_t at, std::uint8_t data) {
    pins_->body_write_i = 1;
    pins_->body_address_i = at;
    pins_->body_data_i = data;
    tick();
    pins_->body_write_i = 0;
  }
  std::uint8_t get(std::uint8_t at) {
    pins_->body_address_i = at;
    settle();
    return pins_->body_data_o;
  }

 private:
  void access(std::uint32_t address, bool write, std::uint32_t data) {
    pins_->select_i = 1;
    pins_->write_i = write ? 1 : 0;
    pins_->address_i = static_cast<std::uint8_t>((address - reg::Mailbox::kRequest) / 4);
    pins_->write_data_i = data;
    settle();
  }
  void release() {
    tick();
    pins_->select_i = 0;
    pins_->write_i = 0;
    settle();
  }
  Clocked<Vgridrt_mailbox> pins_;
  bool good_ = false;
  std::uint32_t length_ = 0;
};

TEST(Mailbox, BodiesGoBothWays) {
  Mailbox box;
  std::mt19937 random(2);
  for (int round = 0; round < 50; ++round) {
    std::array<std::uint8_t, 63> sent{};
    for (std::uint8_t i = 0; i < sent.size(); ++i) {
      sent[i] = static_cast<std::uint8_t>(random());
      box.put(i, sent[i]);
    }
    EXPECT_FALSE(box.asked());
    box.ask(true, 7, 63);
    EXPECT_EQ(box.read(reg::Mailbox::kRequest) & 0x80FFFFFFU, 0x803F0107U);
    for (std::uint32_t w = 0; w < 15; ++w) {
      const std::uint32_t word = box.read(reg::MailboxBody::kWords + 4 * w);
      for (std::uint32_t b = 0; b < 4; ++b) ASSERT_EQ(word >> 8 * b & 0xFFU, sent[4 * w + b]);
    }
    const auto data = static_cast<std::uint32_t>(random());
    box.write(reg::MailboxBody::kWords + 20, data);
    EXPECT_TRUE(box.answer(box.tag(), round % 2 == 0, 24));
    EXPECT_EQ(box.good(), round % 2 == 0);
    EXPECT_EQ(box.length(), 24U);
    box.withdraw();
    EXPECT_FALSE(box.asked());
    for (std::uint8_t b = 0; b < 4; ++b) EXPECT_EQ(box.get(20 + b), data >> 8 * b & 0xFFU);
    EXPECT_EQ(box.get(0), sent[0]);
  }
}

TEST(Mailbox, AnAnswerToARequestThatIsGoneIsNoAnswerToTheNext) {
  Mailbox box;
  box.ask(false, 1, 0);
  const std::uint32_t old = box.tag();
  box.withdraw();
  EXPECT_FALSE(box.answer(old, true, 8));
  box.ask(false, 2, 0);
  EXPECT_NE(box.tag(), old);
  EXPECT_FALSE(box.answer(old, true, 8));
  EXPECT_TRUE(box.asked());
  EXPECT_TRUE(box.answer(box.tag(), true, 8));
}

TEST(Mailbox, AnInputReportWaitsUntilItIsTaken) {
  Mailbox box;
  EXPECT_EQ(box->event_valid_o, 0);
  for (std::uint32_t w = 0; w < 16; ++w) {
    box.write(reg::EventBody::kWords + 4 * w, 0x03020100U + 0x04040404U * w);
  }
  box.write(reg::Mailbox::kEvent, 32);
  EXPECT_EQ(box.read(reg::Mailbox::kEvent) >> reg::Mailbox::kEventBusyBit, 1U);
  EXPECT_NE(box->event_valid_o, 0);
  EXPECT_EQ(box->event_id_o, 32);
  for (std::uint8_t i = 0; i < 63; ++i) {
    box->event_address_i = i;
    box.settle();
    ASSERT_EQ(box->event_data_o, i);
  }
  box->event_taken_i = 1;
  box.tick();
  box->event_taken_i = 0;
  EXPECT_EQ(box->event_valid_o, 0);
  EXPECT_EQ(box.read(reg::Mailbox::kEvent), 0U);
}

}  // namespace
}  // namespace gridrt::rtl
