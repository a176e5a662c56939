// A SimBoard around a class that Verilator has made of a board's RTL. It drives pins; everything
// else is the RTL's.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include <verilated.h>
#include <verilated_fst_c.h>

#include "hal/sim/board.hpp"

namespace gridrt {

/// `Model` has the ports of rtl/gridrt_core.sv.
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
    model_->reg_valid_i = 0;
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
                const RunLimits& limits, RegisterAccess* access) override {
    choose_context();
    Model& pins = *model_;
    RunResult moved;
    std::uint64_t quiet = 0;
    std::uint64_t gap = 0;
    if (access != nullptr) {
      pins.reg_valid_i = 1;
      pins.reg_write_i = access->write ? 1 : 0;
      pins.reg_address_i = static_cast<std::uint16_t>(access->address);
      pins.reg_write_data_i = access->data;
    }
    for (;;) {
      const bool offer = moved.taken < to_board.size();
      pins.rx_valid_i = offer ? 1 : 0;
      if (offer) pins.rx_data_i = static_cast<std::uint8_t>(to_board[moved.taken]);
      const bool room = moved.given < from_board.size();
      pins.tx_ready_i = room ? 1 : 0;
      fall();  // the outputs follow the inputs; what the rising edge does is decided
      const bool took = offer && pins.rx_ready_o != 0;
      const bool gave = room && pins.tx_valid_o != 0;
      if (took) ++moved.taken;
      if (gave) from_board[moved.given++] = static_cast<std::byte>(pins.tx_data_o);
      if (access != nullptr && pins.reg_ready_o != 0) {
        access->data = pins.reg_read_data_o;
        access->done = true;
      }
      rise();
      if (access != nullptr && access->done) break;
      quiet = took || gave ? 0 : quiet + 1;
      gap = gave || moved.given == 0 ? 0 : gap + 1;
      if (quiet >= limits.quiet || gap >= limits.gap) break;
      if (access == nullptr && moved.given == from_board.size()) break;
      if (limits.stop_if_sent && moved.taken == to_board.size()) break;
    }
    pins.reg_valid_i = 0;
    return moved;
  }

  [[nodiscard]] std::uint64_t clocks() const override { return clocks_; }

 private:
  /// Verilator's library looks some things up in the context of the thread, which is one of several
  /// boards' and may be gone.
  void choose_context() { Verilated::threadContextp(context_.get()); }
  void fall() {
    model_->clk_i = 0;
    model_->eval();
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
};

}  // namespace gridrt
