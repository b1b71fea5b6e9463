// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fcntl.h>
#include <hdf5.h>
#include <sys/mman.h>
#include <unistd.h>

/// HDF5 keeps a file whose last bytes it could not write, and crashes on it when it is shut down (MPI does that at its
/// end). So it must never come to that. For base/hdf5.cpp alone, which sees HDF5.
/// tested: tests/base/hdf5_test.cpp (ShutsDownAfterAFullDisk)
namespace isostat::hdf5
{
inline int descriptor_of(hid_t file)
{
  void *found = nullptr;
  return H5Fget_vfd_handle(file, H5P_DEFAULT, &found) < 0 ? -1 : *static_cast<int *>(found);
}

/// Room on the disk for all that HDF5 has yet to write to a file. @return errno, 0 if there is
inline int reserve_room(hid_t file)
{
  hsize_t bytes = 0;
  return H5Fget_filesize(file, &bytes) < 0 ? 0 : ::posix_fallocate(descriptor_of(file), 0, static_cast<off_t>(bytes));
}

/// What is still written to a file that is given up goes to memory.
inline void divert_to_memory(hid_t file)
{
  const int memory = ::memfd_create("abandoned", 0);
  ::dup2(memory, descriptor_of(file));
  ::close(memory);
}
} // namespace isostat::hdf5
