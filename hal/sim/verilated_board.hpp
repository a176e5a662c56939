// A SimBoard around a class that Verilator has made of a board's RTL. It drives pins; everything
// else is the RTL's.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <verilated.h>
#include <verilated_fst_c.h>

#include "hal/sim/board.hpp"
#include "hal/sim/spi_flash.hpp"

namespace gridrt {

/// `Model` has the ports of rtl/gridrt_board.sv.
template <class Model>
class VerilatedBoard final : public SimBoard {
 public:
  VerilatedBoard() : context_(std::make_unique<VerilatedContext>()) {
    choose_context();
    context_->traceEverOn(true);
    model_ = std::make_unique<Model>(context_.get());
    model_->clk_i = 0;
    model_->rst_ni = 0;
    model_->rx_valid_i = 0;
    model_->tx_ready_i = 0;
    model_->request_valid_i = 0;
    model_->body_write_i = 0;
    model_->event_taken_i = 0;
    model_->flash_miso_i = 1;
  }
  ~VerilatedBoard() override {
    choose_context();
    model_->final();
    if (waves_) waves_->close();
  }

  /// Whether the model was made with waves.
  static constexpr bool kHasWaves =
      requires(Model& model, VerilatedFstC* file) { model.trace(file, 1); };

  /// Opens a file for waves; false if that fails, or without kHasWaves. Before power_up().
  bool trace_to(const std::string& path) {
    if constexpr (kHasWaves) {
      waves_ = std::make_unique<VerilatedFstC>();
      constexpr int kAllLevels = 99;
      model_->trace(waves_.get(), kAllLevels);
      waves_->open(path.c_str());
      return waves_->isOpen();
    }
    return false;
  }

  /// What the board's flash holds from flash_address on. Before power_up().
  void set_flash(std::vector<std::byte> content) {
    flash_ = SpiFlash(std::move(content), protocol::kFlashAddress);
  }

  /// Some clocks with reset; the streams are quiet meanwhile.
  void power_up() {
    constexpr int kResetClocks = 8;
    for (int i = 0; i < kResetClocks; ++i) {
      fall();
      rise();
    }
    model_->rst_ni = 1;
  }

  RunResult run(std::span<const std::byte> to_board, std::span<std::byte> from_board,
                const RunLimits& limits, ReportAccess* access) override {
    choose_context();
    Model& pins = *model_;
    RunResult moved;
    std::uint64_t quiet = 0;
    std::uint64_t gap = 0;
    Exchange exchange(access);
    if (ahead_ && !to_board.empty()) {
      moved.taken = 1;
      ahead_ = false;
    }
    for (;;) {
      offer(to_board.subspan(moved.taken));
      const bool room = moved.given < from_board.size();
      pins.tx_ready_i = room ? 1 : 0;
      if (access != nullptr) exchange.drive(pins);
      fall();  // the outputs follow the inputs; what the rising edge does is decided
      const bool took = take_offer(!to_board.empty());
      const bool gave = room && pins.tx_valid_o != 0;
      if (took) ++moved.taken;
      if (gave) from_board[moved.given++] = static_cast<std::byte>(pins.tx_data_o);
      if (access != nullptr) exchange.look(pins);
      rise();
      if (access != nullptr && access->done) break;
      quiet = took || gave ? 0 : quiet + 1;
      gap = gave || moved.given == 0 ? 0 : gap + 1;
      if (quiet >= limits.quiet || gap >= limits.gap) break;
      if (access == nullptr && moved.given == from_board.size()) break;
      if (limits.stop_if_sent && moved.taken == to_board.size()) break;
    }
    pins.request_valid_i = 0;
    pins.body_write_i = 0;
    return moved;
  }

  bool take_input(InputReport& report) override {
    choose_context();
    Model& pins = *model_;
    pins.tx_ready_i = 0;
    pins.rx_valid_i = held_ ? 1 : 0;
    fall();
    const bool there = pins.event_valid_o != 0;
    if (there) report.id = pins.event_id_o;
    for (std::size_t i = 0; there && i < report.body.size(); ++i) {
      pins.rx_valid_i = held_ ? 1 : 0;
      pins.event_address_i = static_cast<std::uint8_t>(i);
      pins.event_taken_i = i + 1 == report.body.size() ? 1 : 0;
      fall();
      report.body[i] = static_cast<std::byte>(pins.event_data_o);
      take_offer(false);
      rise();
    }
    pins.event_taken_i = 0;
    return there;
  }

  void forget() override { held_ = ahead_ = false; }

  [[nodiscard]] std::uint64_t clocks() const override { return clocks_; }

 private:
  /// One control report, as endpoint 0 goes about it: the body that is set byte by byte, the
  /// request, the body that was got byte by byte.
  class Exchange {
   public:
    explicit Exchange(ReportAccess* access) : access_(access) {
      if (access != nullptr && !access->set) writing_ = false;
    }
    void drive(Model& pins) {
      if (writing_ && at_ == access_->length) writing_ = false;
      pins.body_write_i = writing_ ? 1 : 0;
      pins.request_valid_i = !writing_ && !reading_ ? 1 : 0;
      pins.request_set_i = access_->set ? 1 : 0;
      pins.request_id_i = access_->id;
      pins.request_length_i = static_cast<std::uint8_t>(access_->length);
      pins.body_address_i = static_cast<std::uint8_t>(at_);
      if (writing_) pins.body_data_i = static_cast<std::uint8_t>(access_->body[at_]);
    }
    void look(Model& pins) {
      if (writing_) {
        ++at_;
      } else if (reading_) {
        access_->body[at_++] = static_cast<std::byte>(pins.body_data_o);
        access_->done = at_ == access_->length;
      } else if (pins.answer_valid_o != 0) {
        access_->good = pins.answer_good_o != 0;
        if (access_->set)
          access_->length = 0;
        else
          access_->length = std::min<std::size_t>(pins.answer_length_o, access_->body.size());
        reading_ = !access_->set && access_->good && access_->length > 0;
        access_->done = !reading_;
        at_ = 0;
      }
    }

   private:
    ReportAccess* access_;
    bool writing_ = true;
    bool reading_ = false;
    std::size_t at_ = 0;
  };

  /// Offers the first byte of `rest`, or goes on with the one that was offered before.
  void offer(std::span<const std::byte> rest) {
    if (!rest.empty()) {
      held_ = true;
      model_->rx_data_i = static_cast<std::uint8_t>(rest.front());
    }
    model_->rx_valid_i = held_ ? 1 : 0;
  }
  /// Whether the rising edge takes a byte that this run counts; another is counted by the next.
  bool take_offer(bool counted) {
    if (!held_ || model_->rx_ready_o == 0) return false;
    held_ = false;
    ahead_ = !counted;
    return counted;
  }

  /// Verilator's library looks some things up in the context of the thread, which is one of several
  /// boards' and may be gone.
  void choose_context() { Verilated::threadContextp(context_.get()); }
  void fall() {
    model_->clk_i = 0;
    model_->eval();
    if (model_->flash_cs_no == 0 || flash_selected_) {
      flash_selected_ = model_->flash_cs_no == 0;
      model_->flash_miso_i =
          flash_.step(flash_selected_, model_->flash_clk_o != 0, model_->flash_mosi_o != 0) ? 1 : 0;
    }
    if (waves_) waves_->dump(2 * clocks_);
  }
  void rise() {
    model_->clk_i = 1;
    model_->eval();
    if (waves_) waves_->dump(2 * clocks_ + 1);
    ++clocks_;
  }

  std::unique_ptr<VerilatedContext> context_;
  std::unique_ptr<Model> model_;
  std::unique_ptr<VerilatedFstC> waves_;
  std::uint64_t clocks_ = 0;
  SpiFlash flash_;
  bool flash_selected_ = false;
  bool held_ = false;   // a byte is on offer, and stays so until it is taken
  bool ahead_ = false;  // and was taken when the caller had nothing to send
};

}  // namespace gridrt
