// Run by mpirun with three ranks: rank 1 stops in the midst of sending a large parcel. Rank 0 has
// to go on, hears rank 2 meanwhile, and gets the parcel whole, and what follows it, when rank 1
// goes on.
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

#include <unistd.h>

#include "host/mpi/mpi_postbox.hpp"
#include "host/mpi/ranks.hpp"

namespace gridrt {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr int kDevice = 7;
constexpr std::size_t kBytes = std::size_t{8} << 20U;
constexpr unsigned kLimit = 60;  // seconds, then the program is killed
constexpr int kParcels = 20;     // of rank 2

[[noreturn]] void fail_with(const char* what) {
  std::fprintf(stderr, "mpi_stopped_sender: %s\n", what);
  std::_Exit(1);
}

bool is_stopped(std::uint64_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::stringstream text;
  text << file.rdbuf();
  return text.str().find(") T") != std::string::npos;
}

std::byte pattern(std::size_t i) { return static_cast<std::byte>(i * 131 >> 3U); }

Parcel next(Postbox& postbox) {
  while (true) {
    auto parcel = postbox.receive(kDevice);
    if (!parcel) fail_with(parcel.error().message.c_str());
    if (*parcel) return std::move(**parcel);
  }
}

void post(Postbox& postbox, int to, std::uint64_t number, std::vector<std::byte> content = {}) {
  if (!postbox.send({ParcelKind::kAnswer, to, kDevice, number, std::move(content)})) {
    fail_with("cannot send");
  }
}

void host(Postbox& postbox) {
  const std::uint64_t pid = next(postbox).number;
  post(postbox, 1, 0);
  while (!is_stopped(pid)) std::this_thread::sleep_for(milliseconds(1));
  post(postbox, 2, 0);
  for (int i = 0; i < kParcels; ++i) {
    const Parcel parcel = next(postbox);
    if (parcel.peer != 2 || parcel.number != static_cast<std::uint64_t>(i)) {
      fail_with("something else than rank 2's parcels, in their order");
    }
  }
  const auto end = steady_clock::now() + milliseconds(500);
  while (steady_clock::now() < end) {
    const auto parcel = postbox.receive(kDevice);
    if (!parcel || *parcel) fail_with("a parcel from a rank that is stopped");
  }
  kill(static_cast<pid_t>(pid), SIGCONT);
  const Parcel large = next(postbox);
  if (large.number != 1 || large.content.size() != kBytes) fail_with("not the large parcel");
  for (std::size_t i = 0; i < kBytes; ++i) {
    if (large.content[i] != pattern(i)) fail_with("the large parcel has other bytes");
  }
  if (next(postbox).number != 2) fail_with("not what follows the large parcel");
  post(postbox, 1, 0);
  std::puts("all parcels came");
}

/// Stops itself while its parcel is under way, and is there until rank 0 has all.
void sender(Postbox& postbox) {
  post(postbox, 0, static_cast<std::uint64_t>(getpid()));
  next(postbox);  // a connection is made by both ends
  std::vector<std::byte> content(kBytes);
  for (std::size_t i = 0; i < kBytes; ++i) content[i] = pattern(i);
  post(postbox, 0, 1, std::move(content));
  post(postbox, 0, 2);
  raise(SIGSTOP);
  next(postbox);
}

void other(Postbox& postbox) {
  next(postbox);
  for (int i = 0; i < kParcels; ++i) post(postbox, 0, static_cast<std::uint64_t>(i));
}

int run() {
  alarm(kLimit);
  const Ranks ranks;
  {
    const auto postbox = make_mpi_postbox();
    if (postbox->ranks() != 3) fail_with("run me with: mpirun -n 3");
    constexpr std::array kParts = {host, sender, other};
    kParts[static_cast<std::size_t>(postbox->rank())](*postbox);
  }
  return ranks.serves() ? ranks.serve() : 0;
}

}  // namespace
}  // namespace gridrt

int main() { return gridrt::run(); }
