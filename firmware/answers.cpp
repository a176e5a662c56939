#include "firmware/answers.hpp"

namespace gridrt::firmware {

uint32_t Answers::word(uint32_t at) const {
  return static_cast<uint32_t>(bytes_[at]) | static_cast<uint32_t>(bytes_[at + 1]) << 8U |
         static_cast<uint32_t>(bytes_[at + 2]) << 16U |
         static_cast<uint32_t>(bytes_[at + 3]) << 24U;
}

void Answers::add(uint8_t byte) {
  if (count_ < kKept) bytes_[count_] = byte;
  ++count_;
  if (count_ == wire::FrameHeader::kBytes) {
    const uint32_t length = word(wire::FrameHeader::kLengthAt);
    frame_bytes_ += (length < wire::kMaxPayload ? length : wire::kMaxPayload) + kTail;
  }
  if (count_ >= frame_bytes_ && count_ > wire::FrameHeader::kBytes) finish();
}

void Answers::finish() {
  const auto type = static_cast<wire::FrameType>(bytes_[wire::FrameHeader::kTypeAt]);
  if (type == wire::FrameType::kNoOp && word(wire::FrameHeader::kSequenceAt) == commit_) {
    committed_ = true;
  }
  if (type == wire::FrameType::kError && !refused_) {
    refused_ = true;
    code_ = static_cast<uint16_t>(word(wire::FrameHeader::kBytes));
    detail_ = word(wire::FrameHeader::kBytes + wire::ErrorBody::kDetailAt);
  }
  count_ = 0;
  frame_bytes_ = wire::FrameHeader::kBytes;
}

}  // namespace gridrt::firmware
