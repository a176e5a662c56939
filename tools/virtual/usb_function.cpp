#include "tools/virtual/usb_function.hpp"

#include <algorithm>
#include <utility>

#include "gridrt_usb.hpp"

namespace gridrt {
namespace {

// Chapter 9 of USB 2.0.
constexpr std::uint8_t kToHost = 0x80;
constexpr std::uint8_t kStandardDevice = 0x00;
constexpr std::uint8_t kStandardInterface = 0x01;
constexpr std::uint8_t kStandardEndpoint = 0x02;
constexpr std::uint8_t kClassInterface = 0x21;
constexpr std::uint8_t kVendorDevice = 0x40;
enum StandardRequest : std::uint8_t {
  kGetStatus = 0,
  kClearFeature = 1,
  kSetFeature = 3,
  kSetAddress = 5,
  kGetDescriptor = 6,
  kGetConfiguration = 8,
  kSetConfiguration = 9,
  kGetInterface = 10,
  kSetInterface = 11,
};
constexpr std::uint16_t kEndpointHalt = 0;

// HID 1.11, 7.2.
enum HidRequest : std::uint8_t {
  kGetReport = 0x01,
  kGetIdle = 0x02,
  kSetReport = 0x09,
  kSetIdle = 0x0A,
};
constexpr std::uint16_t kMicrosoftSet = 7;

ControlAnswer bytes_of(std::span<const std::uint8_t> bytes) {
  const auto view = std::as_bytes(bytes);
  return std::vector<std::byte>(view.begin(), view.end());
}

ControlAnswer byte_of(unsigned value) {
  return std::vector<std::byte>{static_cast<std::byte>(value)};
}

ControlAnswer done() { return std::vector<std::byte>{}; }

}  // namespace

UsbFunction::UsbFunction(Endpoint& endpoint, UsbFunctionOptions options)
    : endpoint_(endpoint), options_(std::move(options)) {}

void UsbFunction::reset() {
  configuration_ = 0;
  idle_ = 0;
  halted_.fill(false);
  told_.reset();
}

ControlAnswer UsbFunction::control(const SetupPacket& setup, std::span<const std::byte> data) {
  if (gone_) return std::nullopt;
  ControlAnswer answer;
  const auto kind = static_cast<std::uint8_t>(setup.request_type & 0x7FU);
  if (kind == kClassInterface) {
    answer = report(setup, data);
  } else if (kind == kVendorDevice) {
    const bool wanted = (setup.request_type & kToHost) != 0 &&
                        setup.request == usb::kMicrosoftRequest && setup.index == kMicrosoftSet;
    answer = wanted ? bytes_of(usb::kMicrosoftDescriptor) : std::nullopt;
  } else {
    answer = standard(setup);
  }
  if (answer && answer->size() > setup.length) answer->resize(setup.length);
  return answer;
}

ControlAnswer UsbFunction::standard(const SetupPacket& setup) {
  const bool to_host = (setup.request_type & kToHost) != 0;
  switch (setup.request_type & 0x7FU) {
    case kStandardDevice:
      if (to_host && setup.request == kGetDescriptor) return descriptor(setup);
      if (to_host && setup.request == kGetStatus) return std::vector<std::byte>(2);
      if (to_host && setup.request == kGetConfiguration) return byte_of(configuration_);
      if (!to_host && setup.request == kSetAddress) return done();
      if (!to_host && setup.request == kSetConfiguration) {
        if (setup.value != 0 && setup.value != usb::kConfiguration) return std::nullopt;
        reset();
        configuration_ = static_cast<std::uint8_t>(setup.value);
        return done();
      }
      return std::nullopt;
    case kStandardInterface:
      if (setup.index > std::max(usb::kBulkInterface, usb::kHidInterface)) return std::nullopt;
      if (to_host && setup.request == kGetDescriptor) return descriptor(setup);
      if (to_host && setup.request == kGetStatus) return std::vector<std::byte>(2);
      if (to_host && setup.request == kGetInterface) return byte_of(0);
      if (!to_host && setup.request == kSetInterface && setup.value == 0) return done();
      return std::nullopt;
    case kStandardEndpoint:
      return of_endpoint(setup);
    default:
      return std::nullopt;
  }
}

ControlAnswer UsbFunction::of_endpoint(const SetupPacket& setup) {
  const auto address = static_cast<std::uint8_t>(setup.index);
  const bool known = address == 0 || address == kToHost || address == usb::kBulkOut ||
                     address == usb::kBulkIn || address == usb::kInterruptOut ||
                     address == usb::kInterruptIn;
  if (!known) return std::nullopt;
  if ((setup.request_type & kToHost) != 0) {
    if (setup.request != kGetStatus) return std::nullopt;
    std::vector<std::byte> status(2);
    status[0] = static_cast<std::byte>(halted_[slot(address)] ? 1 : 0);
    return status;
  }
  if (setup.value != kEndpointHalt) return std::nullopt;
  if (setup.request != kClearFeature && setup.request != kSetFeature) return std::nullopt;
  halted_[slot(address)] = setup.request == kSetFeature;
  return done();
}

ControlAnswer UsbFunction::descriptor(const SetupPacket& setup) const {
  const auto index = static_cast<std::uint8_t>(setup.value);
  const bool of_hid = setup.index == usb::kHidInterface && (setup.request_type & 0x1FU) == 1;
  const auto type = static_cast<std::uint8_t>(setup.value >> 8U);
  if (type == 3) return text(index);
  if (index != 0) return std::nullopt;
  switch (type) {
    case 1:
      return bytes_of(usb::kDeviceDescriptor);
    case 2:
      return options_.high_speed ? bytes_of(usb::kConfigurationHighDescriptor)
                                 : bytes_of(usb::kConfigurationFullDescriptor);
    case 6:
      return bytes_of(usb::kQualifierDescriptor);
    case 7:
      return options_.high_speed ? bytes_of(usb::kOtherSpeedFullDescriptor)
                                 : bytes_of(usb::kOtherSpeedHighDescriptor);
    case 15:
      return bytes_of(usb::kBosDescriptor);
    case 0x21:
      return of_hid ? bytes_of(usb::kHidDescriptor) : std::nullopt;
    case 0x22:
      return of_hid ? bytes_of(usb::kHidReportDescriptor) : std::nullopt;
    default:
      return std::nullopt;
  }
}

ControlAnswer UsbFunction::text(std::uint8_t index) const {
  switch (index) {
    case 0:
      return bytes_of(usb::kLanguagesDescriptor);
    case usb::kManufacturerString:
      return bytes_of(usb::kManufacturerDescriptor);
    case usb::kProductString:
      return bytes_of(usb::kProductDescriptor);
    case usb::kBulkString:
      return bytes_of(usb::kBulkNameDescriptor);
    case usb::kHidString:
      return bytes_of(usb::kHidNameDescriptor);
    case usb::kSerialString: {
      std::vector<std::byte> out{static_cast<std::byte>(2 + 2 * options_.serial.size()),
                                 std::byte{3}};
      for (const char c : options_.serial) {
        out.push_back(static_cast<std::byte>(c));
        out.push_back(std::byte{0});
      }
      return out;
    }
    default:
      return std::nullopt;
  }
}

ControlAnswer UsbFunction::report(const SetupPacket& setup, std::span<const std::byte> data) {
  if (setup.index != usb::kHidInterface || !is_configured()) return std::nullopt;
  const auto id = static_cast<std::uint8_t>(setup.value);
  if ((setup.request_type & kToHost) != 0) {
    if (setup.request == kGetIdle) return byte_of(idle_);
    if (setup.request != kGetReport) return std::nullopt;
    std::vector<std::byte> answer(protocol::kReportBytes);
    answer[0] = static_cast<std::byte>(id);
    if (!endpoint_.get_feature(id, std::span(answer).subspan(1))) return std::nullopt;
    return answer;
  }
  if (setup.request == kSetIdle) {
    idle_ = static_cast<std::uint8_t>(setup.value >> 8U);
    return done();
  }
  if (setup.request != kSetReport || data.empty() || data[0] != static_cast<std::byte>(id) ||
      data.size() > protocol::kReportBytes) {
    return std::nullopt;
  }
  if (!endpoint_.set_feature(id, data.subspan(1))) return std::nullopt;
  return done();
}

TransferState UsbFunction::state_of(std::uint8_t endpoint) const {
  if (gone_) return TransferState::kGone;
  if (!is_configured() || halted_[slot(endpoint)]) return TransferState::kStalled;
  return TransferState::kDone;
}

TransferState UsbFunction::bulk_out(std::span<const std::byte> bytes) {
  const TransferState state = state_of(usb::kBulkOut);
  if (state != TransferState::kDone) return state;
  gone_ = !endpoint_.consume(bytes);
  return state_of(usb::kBulkOut);
}

TransferState UsbFunction::bulk_in(std::span<std::byte> room, std::size_t& given,
                                   std::chrono::milliseconds patience) {
  given = 0;
  const TransferState state = state_of(usb::kBulkIn);
  if (state != TransferState::kDone) return state;
  const Result<std::size_t> produced = endpoint_.produce(room, patience);
  gone_ = !produced;
  if (gone_) return TransferState::kGone;
  given = *produced;
  return given > 0 ? TransferState::kDone : TransferState::kWaiting;
}

TransferState UsbFunction::interrupt_in(std::span<std::byte> room, std::size_t& given) {
  given = 0;
  const TransferState state = state_of(usb::kInterruptIn);
  if (state != TransferState::kDone) return state;
  if (options_.input) {
    given = options_.input(room);
    return given > 0 ? TransferState::kDone : TransferState::kWaiting;
  }
  Report now{static_cast<std::byte>(protocol::StatusReport::kId)};
  if (!endpoint_.get_feature(protocol::StatusReport::kId, std::span(now).subspan(1))) {
    return TransferState::kWaiting;
  }
  if (told_ == now) return TransferState::kWaiting;
  told_ = now;
  given = std::min(room.size(), now.size());
  std::copy_n(now.begin(), given, room.begin());
  return TransferState::kDone;
}

TransferState UsbFunction::interrupt_out(std::span<const std::byte> bytes) {
  const TransferState state = state_of(usb::kInterruptOut);
  if (state != TransferState::kDone) return state;
  // As with a report through endpoint 0, but there is no way to say no.
  if (!bytes.empty()) {
    static_cast<void>(
        endpoint_.set_feature(std::to_integer<std::uint8_t>(bytes[0]), bytes.subspan(1)));
  }
  return TransferState::kDone;
}

}  // namespace gridrt
