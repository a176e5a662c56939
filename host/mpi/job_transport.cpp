#include "host/mpi/job_transport.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <random>
#include <utility>

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include "host/mpi/job.hpp"
#include "host/mpi/job_link.hpp"
#include "host/mpi/job_socket.hpp"

namespace gridrt {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kStartLimit(60000);  ///< for mpirun to bring rank 0 up
constexpr milliseconds kLook(50);           ///< between two looks at whether mpirun has ended
constexpr milliseconds kLastWords(3000);    ///< for mpirun to say why it ends

class JobTransport final : public Transport {
 public:
  JobTransport(Job job, JobLink link, milliseconds limit)
      : job_(std::move(job)), link_(std::move(link)), limit_(limit) {}

  ~JobTransport() override { link_.close(); }  // upon which the job ends

  Result<void> send(std::span<const std::byte> bytes) override {
    if (auto sent = link_.send(LinkKind::kBytes, 0, bytes); !sent) return over();
    return {};
  }

  Result<std::size_t> receive(std::span<std::byte> out, milliseconds timeout) override {
    if (taken_ == bytes_.size()) {
      bytes_.clear();
      taken_ = 0;
      Result<LinkMessage> message = link_.receive(timeout);
      if (!message) return over();
      if (message->kind == LinkKind::kFailed) return std::unexpected(unpack_error(*message));
      if (message->kind == LinkKind::kBytes) bytes_ = std::move(message->content);
    }
    const std::size_t count = std::min(out.size(), bytes_.size() - taken_);
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(taken_), count, out.begin());
    taken_ += count;
    return count;
  }

  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) override {
    const auto size = static_cast<std::uint32_t>(body.size());
    const auto reply = ask(LinkKind::kGetFeature, id, std::as_bytes(std::span(&size, 1)));
    if (!reply) return std::unexpected(reply.error());
    std::ranges::fill(body, std::byte{0});
    std::copy_n(reply->begin(), std::min(reply->size(), body.size()), body.begin());
    return {};
  }

  Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body) override {
    const auto reply = ask(LinkKind::kSetFeature, id, body);
    return reply ? Result<void>{} : std::unexpected(reply.error());
  }

 private:
  Result<std::vector<std::byte>> ask(LinkKind kind, std::uint8_t id,
                                     std::span<const std::byte> content) {
    if (auto sent = link_.send(kind, id, content); !sent) return over();
    const auto end = steady_clock::now() + 2 * limit_;
    for (;;) {
      const auto left = std::chrono::ceil<milliseconds>(end - steady_clock::now());
      Result<LinkMessage> message = link_.receive(std::max(left, milliseconds(0)));
      if (!message) return over();
      switch (message->kind) {
        case LinkKind::kFeature:
          return std::move(message->content);
        case LinkKind::kRefused:
        case LinkKind::kFailed:
          return std::unexpected(unpack_error(*message));
        default:
          bytes_.insert(bytes_.end(), message->content.begin(), message->content.end());
      }
      if (left.count() <= 0) {
        return fail(ErrorKind::kTimeout,
                    fmt::format("the device 'mpi' has not answered for {} ms", 2 * limit_.count()));
      }
    }
  }

  /// Why the link is gone: what rank 0 had to say, or else mpirun.
  std::unexpected<Error> over() {
    for (auto left = link_.receive(milliseconds(0)); left; left = link_.receive(milliseconds(0))) {
      if (left->kind == LinkKind::kFailed) return std::unexpected(unpack_error(*left));
      if (left->kind == LinkKind::kBytes && left->content.empty()) break;
    }
    job_.await_end(kLastWords);
    const std::string words = job_.last_words();
    return fail(ErrorKind::kDevice,
                "the device 'mpi' has failed: its ranks are gone" +
                    (words.empty() ? std::string() : fmt::format(" ({})", words)));
  }

  Job job_;  // ends after the link
  JobLink link_;
  milliseconds limit_;
  std::vector<std::byte> bytes_;
  std::size_t taken_ = 0;  ///< of bytes_
};

std::string new_socket_name() {
  std::random_device random;
  return fmt::format("gridrt-{}-{:08x}{:08x}", getpid(), random(), random());
}

}  // namespace

Result<std::unique_ptr<Transport>> start_job(const RankOptions& options) {
  const std::string name = new_socket_name();
  Result<JobSocket> socket = JobSocket::listen(name);
  if (!socket) return std::unexpected(std::move(socket.error()));
  const int ranks = options.ranks > 0 ? options.ranks : kDefaultRanks;
  Result<Job> job = Job::start(ranks, {name, encode_rank_options(options)});
  if (!job) return std::unexpected(std::move(job.error()));
  const auto end = steady_clock::now() + kStartLimit;
  while (steady_clock::now() < end) {
    if (const int peer = socket->accept(kLook); peer >= 0) {
      return std::make_unique<JobTransport>(std::move(*job), JobLink(peer), options.silence);
    }
    if (!job->ended()) continue;
    return fail(ErrorKind::kDevice, fmt::format("the device 'mpi' cannot start its {} ranks: {}",
                                                ranks, job->last_words()));
  }
  return fail(ErrorKind::kTimeout, fmt::format("the device 'mpi' has not started its {} ranks in "
                                               "{} s",
                                               ranks, kStartLimit.count() / 1000));
}

std::string encode_rank_options(const RankOptions& options) {
  std::array<std::byte, protocol::CapabilitiesReport::kBytes> report{};
  protocol::store(options.capabilities, report);
  std::string text = fmt::format("{},{},{},{},{},", static_cast<int>(options.schedule.schedule),
                                 int{options.schedule.interrupt}, int{options.schedule.feedback},
                                 options.silence.count(), options.groups);
  for (const std::byte b : report) text += fmt::format("{:02x}", static_cast<unsigned>(b));
  return text;
}

Result<RankOptions> decode_rank_options(const std::string& text) {
  const char* at = text.data();
  const char* const end = at + text.size();
  bool good = true;
  const auto number = [&] {
    int value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    good = good && error == std::errc{} && next < end && *next == ',';
    at = good ? next + 1 : end;
    return value;
  };
  RankOptions options;
  options.schedule.schedule = static_cast<Schedule>(number());
  options.schedule.interrupt = number() != 0;
  options.schedule.feedback = number() != 0;
  options.silence = milliseconds(number());
  options.groups = number();
  std::array<std::byte, protocol::CapabilitiesReport::kBytes> report{};
  if (!good || static_cast<std::size_t>(end - at) != 2 * report.size()) {
    return fail(ErrorKind::kUsage, "gridrt-rank is started by the device 'mpi', not by hand");
  }
  for (std::byte& b : report) {
    unsigned value = 0;
    std::from_chars(at, at + 2, value, 16);
    b = static_cast<std::byte>(value);
    at += 2;
  }
  protocol::load(report, options.capabilities);
  return options;
}

}  // namespace gridrt
