// What can go wrong between the host and a board on USB, each with what to do about it.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "hal/error.hpp"

namespace gridrt::usb_error {

Error no_board(const std::string& serial);
Error several_boards(const std::string& serials);
Error no_permission(const std::string& node);
Error no_hid_node(const std::string& port);
Error in_use(const std::string& port);
Error unplugged();
Error interrupted();
Error asleep(const std::string& port);
Error not_a_board(const std::string& what);
Error takes_no_bytes(std::size_t bytes, std::chrono::milliseconds patience);
Error endless(std::size_t bytes);
Error failing(const std::string& pipe, const std::string& how, int times);
Error cannot_open(const std::string& node, const std::string& why);
Error report_timeout(std::uint8_t id);
Error report_refused(std::uint8_t id);
Error no_report(std::uint8_t id);
Error report_failed(std::uint8_t id, const std::string& why);

}  // namespace gridrt::usb_error
