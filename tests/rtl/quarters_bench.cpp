// gridrt_quarters against the host's decoder, for every code.
#include <Vgridrt_quarters.h>
#include <gtest/gtest.h>

#include "host/image/quarter_code.hpp"

namespace gridrt::rtl {
namespace {

TEST(Quarters, EveryCodeMeansWhatTheHostMeans) {
  VerilatedContext context;
  Vgridrt_quarters rtl(&context);
  for (unsigned code = 0; code < 1024; ++code) {
    rtl.code_i = static_cast<std::uint16_t>(code);
    rtl.eval();
    ASSERT_EQ(rtl.masks_o, quarters_of_code(code)) << code;
  }
}

}  // namespace
}  // namespace gridrt::rtl
