#include "firmware/model/board_model.hpp"

#include <algorithm>
#include <utility>

namespace gridrt::firmware {

namespace reg = wire::registers;

namespace {

constexpr std::uint32_t kWindowBytes = 64;
constexpr std::uint32_t kWindowsEnd = reg::Mailbox::kRequest;
constexpr std::uint32_t kAccessClocks = 10;
constexpr std::size_t kWord = 4;

const wire::Window* window_at(std::uint32_t address) {
  const auto* found = std::ranges::find_if(wire::kWindows, [=](const wire::Window& window) {
    return window.base == address / kWindowBytes * kWindowBytes;
  });
  return found == std::end(wire::kWindows) ? nullptr : found;
}

}  // namespace

BoardModel::BoardModel(std::unique_ptr<Endpoint> core, const BoardModelOptions& options)
    : core_(std::move(core)),
      flash_(options.flash),
      reads_(options.reads),
      writes_(options.writes),
      firmware_(*this, options.vectors) {
  std::array<std::byte, 16> text{};
  for (std::size_t i = 0; i < std::min(text.size(), options.serial.size()); ++i) {
    text[i] = static_cast<std::byte>(options.serial[i]);
  }
  for (std::size_t w = 0; w < serial_.size(); ++w) {
    serial_[w] = protocol::detail::get32(text.data() + kWord * w);
  }
  for (const wire::Window& window : wire::kWindows) {
    std::array<std::byte, kWindowBytes> body{};
    const auto there =
        core_->get_feature(window.report, std::span(body).first(kWord * window.words));
    if (there || !window.readable) reports_ |= 1U << window.report;
  }
  firmware_.start();
}

void BoardModel::poll() {
  constexpr int kMostRounds = 16;
  for (int round = 0; round < kMostRounds && firmware_.poll(); ++round) {
  }
}

Result<void> BoardModel::consume(std::span<const std::byte> bytes) {
  poll();
  if (broken_) return std::unexpected(*broken_);
  link_frames_.push(bytes);
  while (const auto event = link_frames_.next()) {
    const auto* frame = std::get_if<Frame>(&*event);
    if (frame != nullptr && frame->type() == protocol::FrameType::kLoadSection) image_lost_ = true;
  }
  if (firmware_speaks_) {
    held_.insert(held_.end(), bytes.begin(), bytes.end());
    return {};
  }
  auto done = core_->consume(bytes);
  look_at_image();
  return done;
}

Result<std::size_t> BoardModel::produce(std::span<std::byte> out,
                                        std::chrono::milliseconds timeout) {
  poll();
  if (broken_) return std::unexpected(*broken_);
  if (firmware_speaks_ || stuck_ != 0) return 0;
  return core_->produce(out, timeout);
}

Result<void> BoardModel::ask(wire::MailboxKind kind, std::uint8_t id, std::size_t length) {
  tag_ = (tag_ + 1) & reg::Mailbox::kRequestTagMask;
  answer_.reset();
  request_ = 1U << reg::Mailbox::kRequestValidBit | tag_ << reg::Mailbox::kRequestTagBit |
             static_cast<std::uint32_t>(length) << reg::Mailbox::kRequestLengthBit |
             static_cast<std::uint32_t>(kind) << reg::Mailbox::kRequestKindBit | id;
  poll();
  if (broken_) return std::unexpected(*broken_);
  if (!answer_) return fail(ErrorKind::kTimeout, "the firmware does not answer");
  if (((*answer_ >> reg::Mailbox::kAnswerGoodBit) & 1U) == 0) {
    return fail(ErrorKind::kUnsupported, "the firmware refuses report " + std::to_string(id));
  }
  return {};
}

Result<void> BoardModel::get_feature(std::uint8_t id, std::span<std::byte> body) {
  body_ = {};
  if (auto done = ask(wire::MailboxKind::kGet, id, 0); !done) return done;
  std::ranges::fill(body, std::byte{0});
  const std::size_t length =
      (answer_.value_or(0) >> reg::Mailbox::kAnswerLengthBit) & reg::Mailbox::kAnswerLengthMask;
  for (std::size_t i = 0; i < std::min({body.size(), length, kWord * body_.size()}); ++i) {
    body[i] = static_cast<std::byte>(body_[i / kWord] >> (8 * (i % kWord)));
  }
  return {};
}

Result<void> BoardModel::set_feature(std::uint8_t id, std::span<const std::byte> body) {
  const std::size_t length = std::min<std::size_t>(body.size(), protocol::kReportBytes - 1);
  body_ = {};
  for (std::size_t i = 0; i < length; ++i) {
    body_[i / kWord] |= std::to_integer<std::uint32_t>(body[i]) << (8 * (i % kWord));
  }
  auto done = ask(wire::MailboxKind::kSet, id, length);
  const bool settable = id == protocol::ResetReport::kId || id == protocol::ControlReport::kId ||
                        id == protocol::CommandReport::kId;
  if (!done && done.error().kind == ErrorKind::kUnsupported && settable) {
    return fail(ErrorKind::kProtocol, done.error().message);
  }
  return done;
}

std::optional<InputReport> BoardModel::take_input() {
  poll();
  if (!event_) return std::nullopt;
  InputReport report;
  report.id = *event_;
  for (std::size_t i = 0; i < report.body.size(); ++i) {
    report.body[i] = static_cast<std::byte>(event_body_[i / kWord] >> (8 * (i % kWord)));
  }
  event_.reset();
  return report;
}

std::uint32_t BoardModel::read(std::uint32_t address) {
  const std::uint32_t value = read_honestly(address);
  return reads_ ? reads_(address, value) : value;
}

std::uint32_t BoardModel::read_honestly(std::uint32_t address) {
  clocks_ += kAccessClocks;
  if (address < kWindowsEnd) return read_window(address);
  if (address >= reg::Watch::kStuck) return read_watch(address);
  if (address >= reg::MailboxBody::kWords && address < reg::MailboxBody::kWords + kWindowBytes) {
    return body_[(address - reg::MailboxBody::kWords) / kWord];
  }
  switch (address) {
    case reg::Mailbox::kRequest:
      return request_;
    case reg::Mailbox::kEvent:
      return (event_ ? 1U : 0U) << reg::Mailbox::kEventBusyBit;
    case reg::Feed::kSource:
      return (firmware_speaks_ ? 1U : 0U) << reg::Feed::kSourceGrantedBit;
    case reg::Feed::kRoom:
      return loader_stopped_ ? 0 : 1;
    case reg::Feed::kAnswer:
      return read_answer();
    case reg::Flash::kStatus:
      return flash_at_ < flash_words_ ? 1U << reg::Flash::kStatusReadyBit : 0U;
    case reg::Flash::kData:
      return flash_word();
    default:
      return 0;
  }
}

void BoardModel::write(std::uint32_t address, std::uint32_t data) {
  if (writes_) writes_(address, data);
  clocks_ += kAccessClocks;
  if (address < kWindowsEnd) return write_window(address, data);
  if (address >= reg::MailboxBody::kWords && address < reg::MailboxBody::kWords + kWindowBytes) {
    body_[(address - reg::MailboxBody::kWords) / kWord] = data;
  } else if (address >= reg::EventBody::kWords && address < reg::EventBody::kWords + kWindowBytes) {
    event_body_[(address - reg::EventBody::kWords) / kWord] = data;
  }
  switch (address) {
    case reg::Mailbox::kAnswer:
      if (((data >> reg::Mailbox::kAnswerTagBit) & reg::Mailbox::kAnswerTagMask) == tag_) {
        answer_ = data;
        request_ = 0;
      }
      return;
    case reg::Mailbox::kEvent:
      event_ = static_cast<std::uint8_t>(data);
      return;
    case reg::Feed::kSource:
      return set_source(data);
    case reg::Feed::kData: {
      std::array<std::byte, kWord> bytes{};
      protocol::detail::put32(bytes.data(), data);
      if (auto done = core_->consume(bytes); !done) broken_ = done.error();
      return look_at_image();
    }
    case reg::Flash::kAddress:
      flash_at_ = (data - wire::kFlashAddress) / kWord;
      return;
    case reg::Watch::kImage:
      image_lost_ = false;
      return look_at_image();
    case reg::Watch::kReset:
      if (data == wire::kCoreResetKey) reset_core();
      return;
    case reg::Watch::kBus:
      bus_ = 0;
      return;
    default:
      return;
  }
}

std::uint32_t BoardModel::read_window(std::uint32_t address) {
  const wire::Window* window = window_at(address);
  if (window == nullptr || !window->readable) return 0;
  if (bus_broken_) {
    bus_ = 1 + address;
    return 0;
  }
  // Reading the first word asks for the report; the others are of the same one.
  std::vector<std::byte>& body = windows_[window->base];
  if (address == window->base || body.empty()) {
    body.assign(kWord * window->words, std::byte{0});
    if (auto done = core_->get_feature(window->report, body);
        !done && done.error().kind != ErrorKind::kUnsupported) {
      broken_ = done.error();
    }
  }
  const std::size_t at = address - window->base;
  return at < body.size() ? protocol::detail::get32(body.data() + at) : 0;
}

void BoardModel::write_window(std::uint32_t address, std::uint32_t data) {
  const wire::Window* window = window_at(address);
  if (window == nullptr || !window->writable) return;
  if (bus_broken_) {
    bus_ = 1 + address;
    return;
  }
  std::vector<std::byte>& body = windows_[window->base];
  body.resize(kWord * window->words);
  const std::size_t at = address - window->base;
  if (at >= body.size()) return;
  protocol::detail::put32(body.data() + at, data);
  if (at + kWord != body.size()) return;  // the last word is the one that counts
  // A frame under way is given up with the shell's state.
  if (window->report == protocol::ResetReport::kId) link_frames_.clear();
  if (auto done = core_->set_feature(window->report, body);
      !done && done.error().kind != ErrorKind::kUnsupported) {
    broken_ = done.error();
  }
  look_at_image();
}

std::uint32_t BoardModel::read_watch(std::uint32_t address) const {
  if (address >= reg::Watch::kSerial && address < reg::Watch::kSerial + kWord * serial_.size()) {
    return serial_[(address - reg::Watch::kSerial) / kWord];
  }
  switch (address) {
    case reg::Watch::kStuck:
      return stuck_;
    case reg::Watch::kLimit:
      return kLimit;
    case reg::Watch::kImage:
      return image_lost_ ? 1 : 0;
    case reg::Watch::kBus:
      return bus_;
    case reg::Watch::kClocks:
      return clocks_;
    case reg::Watch::kReports:
      return reports_;
    default:
      return 0;
  }
}

std::uint32_t BoardModel::read_answer() {
  if (taken_ == answers_.size()) {
    answers_.resize(4096);
    const auto got = core_->produce(answers_, std::chrono::milliseconds(0));
    if (!got) broken_ = got.error();
    answers_.resize(got.value_or(0));
    taken_ = 0;
    if (answers_.empty()) return 0;
  }
  return 1U << reg::Feed::kAnswerValidBit | std::to_integer<std::uint32_t>(answers_[taken_++]);
}

std::uint32_t BoardModel::flash_word() {
  const std::size_t at = kWord * flash_at_++;
  if (at + kWord > flash_.size()) return ~0U;  // erased
  return protocol::detail::get32(flash_.data() + at);
}

void BoardModel::set_source(std::uint32_t data) {
  const bool wanted = ((data >> reg::Feed::kSourceWantedBit) & 1U) != 0;
  if (wanted && link_frames_.buffered() != 0) return;  // a frame is under way
  firmware_speaks_ = wanted;
  if (wanted || held_.empty()) return;
  if (auto done = core_->consume(std::exchange(held_, {})); !done) broken_ = done.error();
  look_at_image();
}

void BoardModel::reset_core() {
  ++core_resets_;
  stuck_ = 0;
  bus_broken_ = loader_stopped_ = false;
  answers_.clear();
  taken_ = 0;
  link_frames_.clear();
  std::array<std::byte, protocol::ResetReport::kBytes> body{};
  protocol::store(protocol::ResetReport{protocol::kResetKey}, body);
  if (auto done = core_->set_feature(protocol::ResetReport::kId, body); !done) {
    broken_ = done.error();
  }
  look_at_image();
}

void BoardModel::look_at_image() {
  std::array<std::byte, protocol::StatusReport::kBytes> body{};
  if (auto done = core_->get_feature(protocol::StatusReport::kId, body); !done) return;
  if (body[0] != static_cast<std::byte>(protocol::DeviceState::kReady)) image_lost_ = true;
}

}  // namespace gridrt::firmware
