// The frame reader on streams built from the input: good frames among garbage, frames with changed
// headers and shortened frames, cut at random. Every good frame must come out, the cuts must not
// matter, and every byte must be accounted for.
#include <algorithm>
#include <cstdlib>

#include "hal/crc32c.hpp"
#include "hal/frame.hpp"

namespace {

using gridrt::Frame;
using gridrt::FrameFault;
using gridrt::FrameReader;
using gridrt::protocol::FrameHeader;

constexpr std::uint32_t kMaxPayload = 1024;

void require(bool condition) {
  if (!condition) std::abort();
}

/// The input as a row of choices.
class Input {
 public:
  explicit Input(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  [[nodiscard]] bool empty() const { return at_ >= bytes_.size(); }
  std::uint8_t byte() { return empty() ? std::uint8_t{0} : bytes_[at_++]; }
  std::vector<std::byte> take(std::size_t count) {
    std::vector<std::byte> out;
    for (std::size_t i = 0; i < count && !empty(); ++i) out.push_back(std::byte{byte()});
    return out;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

/// Where a frame lies in the stream.
struct Place {
  std::size_t start;
  std::size_t end;
  friend bool operator==(const Place&, const Place&) = default;
};

struct Stream {
  std::vector<std::byte> bytes;
  std::vector<Place> good;  // frames that must come out
};

std::vector<std::byte> make_frame(Input& input, std::uint32_t sequence) {
  std::vector<std::byte> out;
  const std::vector<std::byte> payload = input.take(input.byte());
  require(gridrt::append_frame(out, static_cast<gridrt::protocol::FrameType>(input.byte()),
                               static_cast<gridrt::protocol::Layout>(input.byte()), sequence,
                               payload)
              .has_value());
  return out;
}

/// Changes a field of the header and makes its CRC right again.
void change_header(std::vector<std::byte>& frame, Input& input) {
  const std::size_t at = input.byte() % (FrameHeader::kBytes - 4);
  frame[at] ^= std::byte{input.byte()};
  gridrt::protocol::detail::put32(frame.data() + 16, gridrt::crc32c(std::span(frame).first(16)));
}

Stream make_stream(Input& input) {
  Stream stream;
  std::uint32_t sequence = 0;
  while (!input.empty()) {
    std::vector<std::byte> piece;
    switch (input.byte() % 5) {
      case 0:
      case 1:
        piece = make_frame(input, sequence++);
        stream.good.push_back({stream.bytes.size(), stream.bytes.size() + piece.size()});
        break;
      case 2:  // garbage without the first byte of the magic, so that it is surely garbage
        piece = input.take(input.byte());
        std::ranges::replace(piece, std::byte{'G'}, std::byte{'g'});
        break;
      case 3:
        piece = make_frame(input, 0x80000000U);
        change_header(piece, input);
        break;
      default:
        piece = make_frame(input, 0x80000000U);
        piece.resize(input.byte() % piece.size());
        break;
    }
    stream.bytes.insert(stream.bytes.end(), piece.begin(), piece.end());
  }
  return stream;
}

struct Answer {
  std::vector<Place> frames;
  std::vector<std::uint32_t> faults;
  std::size_t frame_bytes = 0;
  std::uint64_t garbage = 0;
  std::uint64_t bad = 0;
  friend bool operator==(const Answer&, const Answer&) = default;
};

/// Takes what the reader has; `stream` is what was pushed, from its first byte.
void drain(FrameReader& reader, std::span<const std::byte> stream, Answer& answer) {
  while (const auto event = reader.next()) {
    if (const auto* frame = std::get_if<Frame>(&*event)) {
      require(frame->header.length == frame->payload.size());
      require(frame->header.length <= kMaxPayload);
      const std::size_t start = reader.garbage_bytes() + answer.frame_bytes;
      answer.frame_bytes += frame->bytes.size();
      require(std::ranges::equal(frame->bytes, stream.subspan(start, frame->bytes.size())));
      answer.frames.push_back({start, start + frame->bytes.size()});
    } else {
      answer.faults.push_back(std::get<FrameFault>(*event).header.sequence);
    }
  }
}

Answer read(std::span<const std::byte> stream, std::size_t piece) {
  FrameReader reader(kMaxPayload);
  Answer answer;
  for (std::size_t at = 0; at < stream.size(); at += piece) {
    reader.push(stream.subspan(at, std::min(piece, stream.size() - at)));
    drain(reader, stream, answer);
    require(reader.buffered() < kMaxPayload + gridrt::kFrameOverhead);
  }
  // What a shortened frame still waits for never comes.
  for (std::size_t before = reader.buffered() + 1; reader.buffered() < before;) {
    before = reader.buffered();
    reader.resynchronise();
    drain(reader, stream, answer);
  }
  reader.clear();
  answer.garbage = reader.garbage_bytes();
  answer.bad = reader.bad_frames();
  require(answer.garbage + answer.frame_bytes == stream.size());
  return answer;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input({data, size});
  const std::size_t piece = 1U + input.byte();
  const Stream stream = make_stream(input);
  const Answer answer = read(stream.bytes, piece);
  require(answer == read(stream.bytes, stream.bytes.size() + 1));
  for (const Place& good : stream.good) {
    // A fuzzer forges CRCs: a frame may have ended up within the payload of another good one.
    require(std::ranges::any_of(answer.frames, [&](const Place& frame) {
      return frame == good || (frame.start < good.start && frame.end > good.start);
    }));
  }
  // And the input itself as a stream.
  const auto raw = std::as_bytes(std::span(data, size));
  require(read(raw, piece) == read(raw, size + 1));
  return 0;
}
