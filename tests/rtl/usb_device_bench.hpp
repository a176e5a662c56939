// The whole device at its UTMI port: a USB host on one side, a flash on the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <Vgridrt_device.h>

#include "gridrt_protocol.hpp"
#include "hal/sim/spi_flash.hpp"
#include "tests/rtl/clocked.hpp"
#include "tests/rtl/usb_board_host.hpp"

namespace gridrt::rtl {

/// What went over the link between the USB block and the board, in clocks.
struct LinkClocks {
  long all = 0;
  long hears = 0;    ///< the board took a byte
  long waits = 0;    ///< it would have, but there was none
  long speaks = 0;   ///< the USB block took a byte of the board
  long blocked = 0;  ///< it left one waiting
};

class DeviceBench {
 public:
  /// `flash` is what the flash holds from flash_address on.
  explicit DeviceBench(std::vector<std::byte> flash = {})
      : flash_(std::move(flash), protocol::kFlashAddress),
        host([this](Utmi& pins) { tick(pins); }) {
    device_->utmi_rx_error_i = device_->utmi_rx_active_i = device_->utmi_rx_valid_i = 0;
    device_->utmi_tx_ready_i = 1;
    device_->utmi_busy_i = 0;
    device_->utmi_line_state_i = 1;
    device_->flash_miso_i = 1;
    device_.reset();
  }

  Vgridrt_device& pins() { return *device_; }
  LinkClocks& link() { return link_; }

 private:
  void tick(Utmi& pins) {
    device_->utmi_rx_active_i = pins.rx_active ? 1 : 0;
    device_->utmi_rx_valid_i = pins.rx_valid ? 1 : 0;
    device_->utmi_rx_error_i = pins.rx_error ? 1 : 0;
    device_->utmi_rx_data_i = pins.rx_data;
    device_->utmi_line_state_i = pins.line_state;
    device_->utmi_tx_ready_i = pins.tx_ready ? 1 : 0;
    device_.settle();
    ++link_.all;
    link_.hears += device_->hears_o;
    link_.waits += device_->waits_o;
    link_.speaks += device_->speaks_o;
    link_.blocked += device_->blocked_o;
    device_->flash_miso_i = flash_.step(device_->flash_cs_no == 0, device_->flash_clk_o != 0,
                                        device_->flash_mosi_o != 0)
                                ? 1
                                : 0;
    device_.tick();
    pins.tx_valid = device_->utmi_tx_valid_o != 0;
    pins.tx_data = device_->utmi_tx_data_o;
  }

  Clocked<Vgridrt_device> device_;
  SpiFlash flash_;
  LinkClocks link_;

 public:
  UsbBoardHost host;
};

}  // namespace gridrt::rtl
