// Reads the shell's answers while an image is being loaded.
#pragma once

#include <stdint.h>

#include "gridrt_firmware_protocol.hpp"

namespace gridrt::firmware {

/// Takes frames a byte at a time. They come over a wire on the chip, so their CRCs are not looked
/// at; lengths are.
class Answers {
 public:
  /// `commit` is the sequence number of the frame whose NoOp is waited for.
  explicit Answers(uint32_t commit) : commit_(commit) {}

  void add(uint8_t byte);

  /// The image was accepted.
  [[nodiscard]] bool committed() const { return committed_; }
  /// An Error has come; the first one counts.
  [[nodiscard]] bool refused() const { return refused_; }
  [[nodiscard]] uint16_t code() const { return code_; }
  [[nodiscard]] uint32_t detail() const { return detail_; }

 private:
  static constexpr uint32_t kTail = 4;  // the payload's CRC
  static constexpr uint32_t kKept = wire::FrameHeader::kBytes + wire::ErrorBody::kBytes;

  [[nodiscard]] uint32_t word(uint32_t at) const;
  void finish();

  uint8_t bytes_[kKept] = {};
  uint32_t count_ = 0;                                // of this frame
  uint32_t frame_bytes_ = wire::FrameHeader::kBytes;  // grows once the length is known
  uint32_t commit_;
  uint32_t detail_ = 0;
  uint16_t code_ = 0;
  bool committed_ = false;
  bool refused_ = false;
};

}  // namespace gridrt::firmware
