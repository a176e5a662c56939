/// Clock and reset of a verilated module with the ports clk_i and rst_ni.
#pragma once

#include <memory>
#include <utility>

#include <verilated.h>

namespace gridrt::rtl {

/// A module under test. Between two calls of `tick`, inputs may be set as the module's neighbours
/// would set them after a clock edge; `settle` shows what the outputs make of them.
template <typename Model>
class Clocked {
 public:
  /// Registers without reset start with random bits of this seed, so that nothing relies on zeros.
  explicit Clocked(int seed = 1) {
    context_ = std::make_unique<VerilatedContext>();
    context_->randReset(2);
    context_->randSeed(seed);
    model_ = std::make_unique<Model>(context_.get());
    model_->clk_i = 0;
    model_->rst_ni = 0;
  }
  Clocked(const Clocked&) = delete;
  Clocked& operator=(const Clocked&) = delete;
  Clocked(Clocked&&) = delete;
  Clocked& operator=(Clocked&&) = delete;
  ~Clocked() { model_->final(); }

  Model* operator->() { return model_.get(); }
  Model& operator*() { return *model_; }

  void settle() { model_->eval(); }

  /// One clock: the rising edge, then the falling one.
  void tick() {
    model_->clk_i = 1;
    model_->eval();
    model_->clk_i = 0;
    model_->eval();
    context_->timeInc(1);
    ++clocks_;
  }

  /// Some clocks with reset, then none; the inputs must be quiet.
  void reset() {
    model_->rst_ni = 0;
    for (int i = 0; i < 4; ++i) tick();
    model_->rst_ni = 1;
    settle();
  }

  [[nodiscard]] const VerilatedContext& context() const { return *context_; }

  /// Clocks since the beginning.
  [[nodiscard]] long clocks() const { return clocks_; }

 private:
  std::unique_ptr<VerilatedContext> context_;
  std::unique_ptr<Model> model_;
  long clocks_ = 0;
};

}  // namespace gridrt::rtl
