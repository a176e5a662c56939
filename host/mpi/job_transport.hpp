// The way to a device on the ranks of a job that this program starts.
#pragma once

#include <memory>

#include "host/mpi/connect.hpp"

namespace gridrt {

/// Starts the job. The transport ends it.
Result<std::unique_ptr<Transport>> start_job(const RankOptions& options);

/// What gridrt-rank needs to know, as one word of its command line, and back.
std::string encode_rank_options(const RankOptions& options);
Result<RankOptions> decode_rank_options(const std::string& text);

}  // namespace gridrt
