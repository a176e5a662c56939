// A postbox on MPI_COMM_WORLD: a message for each parcel, the device's number as its tag.
#pragma once

#include <memory>

#include "host/mpi/postbox.hpp"

namespace gridrt {

/// Needs MPI to be initialised, and is used by the thread that did it.
std::unique_ptr<Postbox> make_mpi_postbox();

}  // namespace gridrt
