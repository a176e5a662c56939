#include "hal/usb/messages.hpp"

namespace gridrt::usb_error {
namespace {

constexpr const char* kRule =
    "install the udev rule 70-gridrt.rules (cmake --install puts it into lib/udev/rules.d), run "
    "'udevadm control --reload' as root and plug the board in again";

std::string number(std::size_t n) { return std::to_string(n); }

}  // namespace

Error no_board(const std::string& serial) {
  return {ErrorKind::kTransport,
          serial.empty() ? "no GridRT board is plugged in"
                         : "no GridRT board with serial '" + serial + "' is plugged in",
          "check cable and power; 'gridrt-board list' shows the boards that there are"};
}

Error several_boards(const std::string& serials) {
  return {ErrorKind::kUsage, "more than one GridRT board is plugged in: " + serials,
          "say which: --device usb:SERIAL"};
}

Error no_permission(const std::string& node) {
  return {ErrorKind::kTransport, "no permission to use the board: " + node + " cannot be opened",
          kRule};
}

Error no_hid_node(const std::string& port) {
  return {ErrorKind::kTransport,
          "the board at " + port + " has no hidraw node, so its reports cannot be read",
          "load the kernel's drivers: 'modprobe usbhid'; then plug the board in again"};
}

Error in_use(const std::string& port) {
  return {ErrorKind::kTransport, "another program is using the board at " + port,
          "end it first, or use another board; gridrt-board's reports work meanwhile"};
}

Error unplugged() {
  return {ErrorKind::kTransport, "the board was unplugged, or it lost its power",
          "plug it in again and start anew; its memories are empty after that"};
}

Error interrupted() {
  return {ErrorKind::kTransport,
          "the connection to the board was cut, but it is there again: the computer slept, or the "
          "board was reset",
          "start anew"};
}

Error asleep(const std::string& port) {
  return {ErrorKind::kTransport, "the board at " + port + " sleeps and cannot be woken",
          "plug it in again; if it happens often, write 'on' to its power/control in sysfs"};
}

Error not_a_board(const std::string& what) {
  return {ErrorKind::kUnsupported,
          "the device with the board's USB ids is no GridRT board: " + what,
          "use firmware and program of one release; other devices may share the test id 1209:0001"};
}

Error takes_no_bytes(std::size_t bytes, std::chrono::milliseconds patience) {
  return {ErrorKind::kTimeout,
          "the board has taken none of " + number(bytes) + " bytes for " +
              std::to_string(patience.count()) + " ms",
          "'gridrt-board info' shows its state, 'gridrt-board reset' frees it"};
}

Error endless(std::size_t bytes) {
  return {ErrorKind::kProtocol, "the board sent " + number(bytes) + " bytes that nobody asked for",
          "'gridrt-board reset' ends that; if it comes again, this is a defect of the board"};
}

Error failing(const std::string& pipe, const std::string& how, int times) {
  return {
      ErrorKind::kTransport,
      "the USB pipe " + pipe + " fails: " + how + ", " + std::to_string(times) + " times in a row",
      "try another cable and a port of the computer itself; dmesg may say more"};
}

Error cannot_open(const std::string& node, const std::string& why) {
  return {ErrorKind::kTransport, node + " cannot be opened: " + why,
          "plug the board in again; dmesg may say more"};
}

Error report_timeout(std::uint8_t id) {
  return {ErrorKind::kTimeout, "the board's firmware does not answer report " + std::to_string(id),
          "its watchdog should reset it within seconds: try again, else unplug it"};
}

Error report_refused(std::uint8_t id) {
  return {ErrorKind::kProtocol, "the board refuses the content of report " + std::to_string(id),
          ""};
}

Error no_report(std::uint8_t id) {
  return {ErrorKind::kUnsupported, "the board has no report " + std::to_string(id), ""};
}

Error report_failed(std::uint8_t id, const std::string& why) {
  return {ErrorKind::kTransport, "report " + std::to_string(id) + " could not be exchanged: " + why,
          "plug the board in again; dmesg may say more"};
}

}  // namespace gridrt::usb_error
