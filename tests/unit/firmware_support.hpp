// Boards in software for the tests of the firmware.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "firmware/model/board_model.hpp"
#include "firmware/self_test_vectors.hpp"
#include "host/driver/flash_image.hpp"
#include "host/pe/capabilities.hpp"
#include "host/pe/software_device.hpp"
#include "tests/unit/image_support.hpp"

namespace gridrt {

inline firmware::BoardModelOptions board_options(std::vector<std::byte> flash = {}) {
  return {.serial = "T-42", .flash = std::move(flash), .vectors = firmware::kSelfTestVectors};
}

inline std::unique_ptr<firmware::BoardModel> make_board(
    const firmware::BoardModelOptions& options = board_options()) {
  SoftwareDeviceOptions software;
  software.capabilities = board_capabilities();
  return std::make_unique<firmware::BoardModel>(std::make_unique<SoftwareDevice>(software),
                                                options);
}

/// An image for the board.
inline Image board_image(unsigned seed = 3) {
  ImageOptions options;
  options.layout = protocol::Layout::kCompact;
  return must_build(random_scene(60, seed), options);
}

inline std::vector<std::byte> must_flash(const Image& image) {
  auto flash = flash_image(image, board_capabilities());
  if (!flash) {
    ADD_FAILURE() << flash.error().message;
    return {};
  }
  return std::move(*flash);
}

template <class Report>
Report report(Endpoint& board) {
  std::array<std::byte, Report::kBytes> body{};
  const auto got = board.get_feature(Report::kId, body);
  EXPECT_TRUE(got) << got.error().message;
  Report out;
  protocol::load(body, out);
  return out;
}

template <class Report>
Result<void> set(Endpoint& board, const Report& report) {
  std::array<std::byte, Report::kBytes> body{};
  protocol::store(report, body);
  return board.set_feature(Report::kId, body);
}

inline Result<void> command(Endpoint& board, protocol::BoardCommand what) {
  return set(board, protocol::CommandReport{.command = static_cast<std::uint8_t>(what)});
}

/// All that the journal holds, as pairs of code and detail.
using Entries = std::vector<std::pair<protocol::JournalCode, std::uint32_t>>;
inline Entries read_journal(Endpoint& board) {
  Entries all;
  for (;;) {
    const auto part = report<protocol::JournalReport>(board);
    if (part.count == 0) return all;
    for (std::size_t i = 0; i < part.count; ++i) {
      all.emplace_back(static_cast<protocol::JournalCode>(part.codes[i]), part.details[i]);
    }
  }
}

inline protocol::DeviceState state_of(Endpoint& board) {
  return static_cast<protocol::DeviceState>(report<protocol::StatusReport>(board).state);
}

}  // namespace gridrt
