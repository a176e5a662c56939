#include "tools/virtual/redirection.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>
#include <usbredirparser.h>

#include "gridrt_usb.hpp"

namespace gridrt {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kInterruptPeriod(10);
constexpr std::size_t kMostBulk = std::size_t{1} << 22U;  ///< bytes of one transfer

std::uint8_t status_of(TransferState state) {
  switch (state) {
    case TransferState::kDone:
      return usb_redir_success;
    case TransferState::kStalled:
      return usb_redir_stall;
    default:
      return usb_redir_ioerror;
  }
}

std::size_t slot(std::uint16_t endpoint) {
  return (endpoint & 0x0FU) | ((endpoint & 0x80U) != 0 ? 0x10U : 0U);
}

}  // namespace

/// The parser's callbacks; `priv` is the Redirection.
struct Redirection::Calls {
  static Redirection& self(void* priv) { return *static_cast<Redirection*>(priv); }

  static std::span<const std::byte> view(const std::uint8_t* data, int bytes) {
    return std::as_bytes(std::span(data, static_cast<std::size_t>(std::max(bytes, 0))));
  }

  static void log(void* /*priv*/, int /*level*/, const char* /*text*/) {}

  static int read(void* priv, std::uint8_t* data, int count) {
    const ssize_t got = recv(self(priv).socket_, data, static_cast<std::size_t>(count), 0);
    if (got > 0) return static_cast<int>(got);
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
    self(priv).closed_ = true;
    return -1;
  }

  static int write(void* priv, std::uint8_t* data, int count) {
    const ssize_t put =
        ::send(self(priv).socket_, data, static_cast<std::size_t>(count), MSG_NOSIGNAL);
    if (put >= 0) return static_cast<int>(put);
    if (errno == EAGAIN || errno == EINTR) return 0;
    self(priv).closed_ = true;
    return -1;
  }

  static void hello(void* priv, usb_redir_hello_header* /*header*/) {
    self(priv).greeted_ = true;
    self(priv).connect();
  }

  static void reset(void* priv) {
    self(priv).function_.reset();
    self(priv).wanted_.clear();
  }

  static void set_configuration(void* priv, std::uint64_t id,
                                usb_redir_set_configuration_header* wanted) {
    Redirection& r = self(priv);
    const auto done =
        r.function_.control({.request_type = 0, .request = 9, .value = wanted->configuration}, {});
    if (done) r.describe();
    usb_redir_configuration_status_header status{};
    status.status = done ? usb_redir_success : usb_redir_stall;
    status.configuration = wanted->configuration;
    usbredirparser_send_configuration_status(r.parser_.get(), id, &status);
  }

  static void get_configuration(void* priv, std::uint64_t id) {
    Redirection& r = self(priv);
    usb_redir_configuration_status_header status{};
    status.configuration = r.function_.is_configured() ? usb::kConfiguration : 0;
    usbredirparser_send_configuration_status(r.parser_.get(), id, &status);
  }

  static void set_alt(void* priv, std::uint64_t id, usb_redir_set_alt_setting_header* wanted) {
    Redirection& r = self(priv);
    const auto done = r.function_.control(
        {.request_type = 1, .request = 11, .value = wanted->alt, .index = wanted->interface}, {});
    usb_redir_alt_setting_status_header status{};
    status.status = done ? usb_redir_success : usb_redir_stall;
    status.interface = wanted->interface;
    usbredirparser_send_alt_setting_status(r.parser_.get(), id, &status);
  }

  static void get_alt(void* priv, std::uint64_t id, usb_redir_get_alt_setting_header* wanted) {
    usb_redir_alt_setting_status_header status{};
    status.interface = wanted->interface;
    usbredirparser_send_alt_setting_status(self(priv).parser_.get(), id, &status);
  }

  static void interrupt_status(Redirection& r, std::uint64_t id, std::uint8_t endpoint, bool on) {
    usb_redir_interrupt_receiving_status_header status{};
    status.status = endpoint == usb::kInterruptIn ? usb_redir_success : usb_redir_inval;
    status.endpoint = endpoint;
    if (endpoint == usb::kInterruptIn) r.interrupts_ = on;
    usbredirparser_send_interrupt_receiving_status(r.parser_.get(), id, &status);
  }

  static void start_interrupt(void* priv, std::uint64_t id,
                              usb_redir_start_interrupt_receiving_header* wanted) {
    interrupt_status(self(priv), id, wanted->endpoint, true);
  }

  static void stop_interrupt(void* priv, std::uint64_t id,
                             usb_redir_stop_interrupt_receiving_header* wanted) {
    interrupt_status(self(priv), id, wanted->endpoint, false);
  }

  static void cancel(void* priv, std::uint64_t id) {
    Redirection& r = self(priv);
    if (std::erase_if(r.wanted_, [id](const Wanted& w) { return w.id == id; }) == 0) return;
    usb_redir_bulk_packet_header header{};
    header.endpoint = usb::kBulkIn;
    header.status = usb_redir_cancelled;
    usbredirparser_send_bulk_packet(r.parser_.get(), id, &header, nullptr, 0);
  }

  static void control(void* priv, std::uint64_t id, usb_redir_control_packet_header* header,
                      std::uint8_t* data, int bytes) {
    Redirection& r = self(priv);
    ControlAnswer answer = r.function_.control({.request_type = header->requesttype,
                                                .request = header->request,
                                                .value = header->value,
                                                .index = header->index,
                                                .length = header->length},
                                               view(data, bytes));
    usbredirparser_free_packet_data(r.parser_.get(), data);
    const bool to_host = (header->requesttype & 0x80U) != 0;
    header->status = answer ? usb_redir_success : usb_redir_stall;
    const std::size_t size = answer && to_host ? answer->size() : 0;
    if (to_host) header->length = static_cast<std::uint16_t>(size);
    auto* begin = size > 0 ? reinterpret_cast<std::uint8_t*>(answer->data()) : nullptr;
    usbredirparser_send_control_packet(r.parser_.get(), id, header, begin, static_cast<int>(size));
  }

  static void bulk(void* priv, std::uint64_t id, usb_redir_bulk_packet_header* header,
                   std::uint8_t* data, int bytes) {
    Redirection& r = self(priv);
    const std::size_t length = header->length | static_cast<std::size_t>(header->length_high)
                                                    << 16U;
    if (header->endpoint == usb::kBulkIn) {
      r.wanted_.push_back({id, std::min(length, kMostBulk)});
    } else {
      const TransferState state = header->endpoint == usb::kBulkOut
                                      ? r.function_.bulk_out(view(data, bytes))
                                      : TransferState::kStalled;
      r.gone_ = r.gone_ || state == TransferState::kGone;
      const std::size_t taken = state == TransferState::kDone ? length : 0;
      r.answer_bulk(id, state, {}, header->endpoint, taken);
    }
    usbredirparser_free_packet_data(r.parser_.get(), data);
  }

  static void interrupt(void* priv, std::uint64_t id, usb_redir_interrupt_packet_header* header,
                        std::uint8_t* data, int bytes) {
    Redirection& r = self(priv);
    const TransferState state = header->endpoint == usb::kInterruptOut
                                    ? r.function_.interrupt_out(view(data, bytes))
                                    : TransferState::kStalled;
    usbredirparser_free_packet_data(r.parser_.get(), data);
    header->status = status_of(state);
    usbredirparser_send_interrupt_packet(r.parser_.get(), id, header, nullptr, 0);
  }

  // Streams, which this device does not have.
  static void free_data(Redirection& r, std::uint8_t* data) {
    usbredirparser_free_packet_data(r.parser_.get(), data);
  }
  static void iso(void* priv, std::uint64_t, usb_redir_iso_packet_header*, std::uint8_t* data,
                  int) {
    free_data(self(priv), data);
  }
  static void buffered(void* priv, std::uint64_t, usb_redir_buffered_bulk_packet_header*,
                       std::uint8_t* data, int) {
    free_data(self(priv), data);
  }
};

void Redirection::Free::operator()(usbredirparser* parser) const { usbredirparser_destroy(parser); }

Redirection::Redirection(UsbFunction& function, int socket)
    : function_(function), socket_(socket), parser_(usbredirparser_create()) {
  usbredirparser& p = *parser_;
  p.priv = this;
  p.log_func = &Calls::log;
  p.read_func = &Calls::read;
  p.write_func = &Calls::write;
  p.hello_func = &Calls::hello;
  p.reset_func = &Calls::reset;
  p.set_configuration_func = &Calls::set_configuration;
  p.get_configuration_func = &Calls::get_configuration;
  p.set_alt_setting_func = &Calls::set_alt;
  p.get_alt_setting_func = &Calls::get_alt;
  p.start_interrupt_receiving_func = &Calls::start_interrupt;
  p.stop_interrupt_receiving_func = &Calls::stop_interrupt;
  p.cancel_data_packet_func = &Calls::cancel;
  p.control_packet_func = &Calls::control;
  p.bulk_packet_func = &Calls::bulk;
  p.iso_packet_func = &Calls::iso;
  p.interrupt_packet_func = &Calls::interrupt;
  p.buffered_bulk_packet_func = &Calls::buffered;
  p.start_iso_stream_func = [](void*, std::uint64_t, usb_redir_start_iso_stream_header*) {};
  p.stop_iso_stream_func = [](void*, std::uint64_t, usb_redir_stop_iso_stream_header*) {};
  p.alloc_bulk_streams_func = [](void*, std::uint64_t, usb_redir_alloc_bulk_streams_header*) {};
  p.free_bulk_streams_func = [](void*, std::uint64_t, usb_redir_free_bulk_streams_header*) {};
  p.start_bulk_receiving_func = [](void*, std::uint64_t, usb_redir_start_bulk_receiving_header*) {};
  p.stop_bulk_receiving_func = [](void*, std::uint64_t, usb_redir_stop_bulk_receiving_header*) {};
  p.filter_reject_func = [](void*) {};
  p.device_disconnect_ack_func = [](void*) {};
  std::uint32_t caps[USB_REDIR_CAPS_SIZE]{};
  for (const int cap : {usb_redir_cap_connect_device_version, usb_redir_cap_device_disconnect_ack,
                        usb_redir_cap_ep_info_max_packet_size, usb_redir_cap_64bits_ids,
                        usb_redir_cap_32bits_bulk_length}) {
    usbredirparser_caps_set_cap(caps, cap);
  }
  usbredirparser_init(parser_.get(), "GridRT virtual board", caps, USB_REDIR_CAPS_SIZE,
                      usbredirparser_fl_usb_host);
}

Redirection::~Redirection() = default;

void Redirection::describe() {
  usb_redir_ep_info_header ends{};
  std::memset(ends.type, usb_redir_type_invalid, sizeof ends.type);
  const bool high = function_.is_high_speed();
  const auto set = [&](std::uint16_t address, std::uint8_t type, std::uint8_t interface,
                       std::uint16_t packet) {
    const std::size_t at = slot(address);
    ends.type[at] = type;
    ends.interface[at] = interface;
    ends.max_packet_size[at] = packet;
    if (type == usb_redir_type_interrupt) {
      ends.interval[at] = static_cast<std::uint8_t>(high ? usb::kInterruptIntervalHigh
                                                         : usb::kInterruptIntervalFull);
    }
  };
  set(0x00, usb_redir_type_control, 0, usb::kControlPacket);
  set(0x80, usb_redir_type_control, 0, usb::kControlPacket);
  usb_redir_interface_info_header interfaces{};
  if (function_.is_configured()) {
    const std::uint16_t packet = high ? usb::kBulkPacketHigh : usb::kBulkPacketFull;
    set(usb::kBulkOut, usb_redir_type_bulk, usb::kBulkInterface, packet);
    set(usb::kBulkIn, usb_redir_type_bulk, usb::kBulkInterface, packet);
    set(usb::kInterruptIn, usb_redir_type_interrupt, usb::kHidInterface, usb::kInterruptPacket);
    set(usb::kInterruptOut, usb_redir_type_interrupt, usb::kHidInterface, usb::kInterruptPacket);
    interfaces.interface_count = 2;
    interfaces.interface[0] = usb::kBulkInterface;
    interfaces.interface_class[0] = 0xFF;
    interfaces.interface[1] = usb::kHidInterface;
    interfaces.interface_class[1] = 3;
  }
  usbredirparser_send_ep_info(parser_.get(), &ends);
  usbredirparser_send_interface_info(parser_.get(), &interfaces);
}

void Redirection::connect() {
  if (!greeted_ || connected_) return;
  function_.reset();
  describe();
  usb_redir_device_connect_header header{};
  header.speed = function_.is_high_speed() ? usb_redir_speed_high : usb_redir_speed_full;
  header.vendor_id = usb::kVendorId;
  header.product_id = usb::kProductId;
  header.device_version_bcd = usb::kDeviceRelease;
  usbredirparser_send_device_connect(parser_.get(), &header);
  connected_ = true;
}

void Redirection::unplug() {
  if (!connected_) return;
  usbredirparser_send_device_disconnect(parser_.get());
  connected_ = false;
  interrupts_ = false;
  wanted_.clear();
}

void Redirection::plug_in() { connect(); }

void Redirection::answer_bulk(std::uint64_t id, TransferState state, std::span<std::byte> data,
                              std::uint8_t endpoint, std::size_t length) {
  usb_redir_bulk_packet_header header{};
  header.endpoint = endpoint;
  header.status = status_of(state);
  header.length = static_cast<std::uint16_t>(length);
  header.length_high = static_cast<std::uint16_t>(length >> 16U);
  usbredirparser_send_bulk_packet(parser_.get(), id, &header,
                                  reinterpret_cast<std::uint8_t*>(data.data()),
                                  static_cast<int>(data.size()));
}

bool Redirection::serve_bulk(milliseconds patience) {
  bool moved = false;
  while (connected_ && !wanted_.empty()) {
    const Wanted wanted = wanted_.front();
    room_.resize(std::max(room_.size(), wanted.bytes));
    std::size_t given = 0;
    const TransferState state =
        function_.bulk_in(std::span(room_).first(wanted.bytes), given, patience);
    if (state == TransferState::kWaiting) break;
    wanted_.pop_front();
    gone_ = gone_ || state == TransferState::kGone;
    answer_bulk(wanted.id, state, std::span(room_).first(given), usb::kBulkIn, given);
    moved = true;
    patience = milliseconds(0);
  }
  return moved;
}

bool Redirection::serve_interrupts() {
  const auto now = std::chrono::steady_clock::now();
  if (!connected_ || !interrupts_ || now < next_interrupt_) return false;
  next_interrupt_ = now + kInterruptPeriod;
  std::array<std::byte, usb::kInterruptPacket> report{};
  std::size_t given = 0;
  if (function_.interrupt_in(report, given) != TransferState::kDone) return false;
  usb_redir_interrupt_packet_header header{};
  header.endpoint = usb::kInterruptIn;
  header.length = static_cast<std::uint16_t>(given);
  usbredirparser_send_interrupt_packet(parser_.get(), 0, &header,
                                       reinterpret_cast<std::uint8_t*>(report.data()),
                                       static_cast<int>(given));
  return true;
}

Result<bool> Redirection::step(milliseconds patience) {
  const bool moved = serve_bulk(milliseconds(0)) || serve_interrupts();
  pollfd watched{socket_, POLLIN, 0};
  if (usbredirparser_has_data_to_write(parser_.get()) > 0) watched.events |= POLLOUT;
  // With work under way an answer may come from the device, not from the socket.
  milliseconds longest = interrupts_ ? std::min(patience, kInterruptPeriod) : patience;
  if (!wanted_.empty()) longest = std::min(patience, milliseconds(1));
  if (moved) longest = milliseconds(0);
  if (poll(&watched, 1, static_cast<int>(longest.count())) < 0 && errno != EINTR) {
    return fail(ErrorKind::kTransport, std::string("poll: ") + std::strerror(errno));
  }
  if ((watched.revents & (POLLIN | POLLHUP | POLLERR)) != 0) {
    usbredirparser_do_read(parser_.get());
  }
  if (usbredirparser_has_data_to_write(parser_.get()) > 0) {
    usbredirparser_do_write(parser_.get());
  }
  if (closed_) return false;
  if (gone_) {
    unplug();
    usbredirparser_do_write(parser_.get());
    return fail(ErrorKind::kDevice, "the device behind the virtual board has failed");
  }
  return true;
}

}  // namespace gridrt
