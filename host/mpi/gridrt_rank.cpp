// gridrt-rank: a rank of the job that the device `mpi` starts where there is none. Rank 0 carries
// frames between the program that started the job and the ranks.
#include <cstdio>
#include <cstring>

#include "host/mpi/job_link.hpp"
#include "host/mpi/job_socket.hpp"
#include "host/mpi/job_transport.hpp"
#include "host/mpi/rank_device.hpp"
#include "host/mpi/ranks.hpp"

namespace gridrt {
namespace {

constexpr int kExitUsage = 2;
constexpr int kExitDevice = 6;
constexpr std::chrono::milliseconds kIdle(200);  ///< wait for frames while no ray is under way
constexpr std::chrono::milliseconds kBusy(1);    ///< work between two looks at the socket
constexpr std::size_t kAnswerBytes = std::size_t{1} << 18U;

Result<void> answer(JobLink& link, const Result<void>& done, std::span<const std::byte> body) {
  if (done) return link.send(LinkKind::kFeature, 0, body);
  return link.send(LinkKind::kRefused, static_cast<std::uint32_t>(done.error().kind),
                   pack_error(done.error()));
}

/// Errors: the device's. A link that is gone is found at the next turn.
Result<void> handle(JobLink& link, SoftwareDevice& device, const LinkMessage& message) {
  const auto id = static_cast<std::uint8_t>(message.number);
  switch (message.kind) {
    case LinkKind::kBytes:
      return device.consume(message.content);
    case LinkKind::kGetFeature: {
      std::uint32_t size = 0;
      std::memcpy(&size, message.content.data(), std::min(sizeof(size), message.content.size()));
      std::vector<std::byte> body(std::min(size, protocol::kReportBytes));
      const Result<void> done = device.get_feature(id, body);
      [[maybe_unused]] const auto told = answer(link, done, body);  // a lost link shows next
      return {};
    }
    case LinkKind::kSetFeature: {
      [[maybe_unused]] const auto told = answer(link, device.set_feature(id, message.content), {});
      return {};
    }
    default:
      return {};
  }
}

/// Until the other end closes the link. Errors: the device's.
Result<void> carry(JobLink& link, SoftwareDevice& device) {
  std::vector<std::byte> out(kAnswerBytes);
  for (;;) {
    const bool busy = device.busy();
    const Result<LinkMessage> message = link.receive(busy ? std::chrono::milliseconds(0) : kIdle);
    if (!message) return {};
    if (message->kind != LinkKind::kBytes || !message->content.empty()) {
      if (auto done = handle(link, device, *message); !done) return done;
    }
    for (;;) {
      const Result<std::size_t> count = device.produce(out, kBusy);
      if (!count) return std::unexpected(count.error());
      if (*count == 0) break;
      if (!link.send(LinkKind::kBytes, 0, std::span(out).first(*count))) return {};
    }
  }
}

int run(int argc, char** argv) {
  constexpr int kWords = 3;
  const auto options =
      argc == kWords
          ? decode_rank_options(argv[2])
          : fail(ErrorKind::kUsage, "gridrt-rank is started by the device 'mpi', not by hand");
  if (!options) {
    std::fprintf(stderr, "gridrt-rank: %s\n", options.error().message.c_str());
    return kExitUsage;
  }
  const Ranks ranks;
  if (ranks.serves()) return ranks.serve();
  const Result<int> descriptor = connect_job_socket(argv[1]);
  if (!descriptor) {
    std::fprintf(stderr, "gridrt-rank: %s\n", descriptor.error().message.c_str());
    return kExitDevice;
  }
  JobLink link(*descriptor);
  const auto device = make_rank_device(*options);
  const Result<void> carried = carry(link, *device);
  if (carried) return 0;
  // The link may be what failed.
  [[maybe_unused]] const auto told =
      link.send(LinkKind::kFailed, static_cast<std::uint32_t>(carried.error().kind),
                pack_error(carried.error()));
  ranks.abandon();
  return kExitDevice;
}

}  // namespace
}  // namespace gridrt

int main(int argc, char** argv) { return gridrt::run(argc, argv); }
