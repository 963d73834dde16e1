#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "slideway/batch/transport.hpp"

/// What the program takes from the environment for the library, which reads none of it.
namespace slideway {

/// What ${SLIDEWAY_DATA} in a problem file stands for: --data DIR, or the environment variable.
std::optional<std::filesystem::path> data_directory(const std::string& option);

/// Whether mpirun, or srun with PMI, has started this process.
bool is_started_by_mpi();

/// The transport of a process that MPI has started, by ../lib/slideway/libslideway_mpi.so relative
/// to the program; nullptr for any other process.
/// @throws UsageError          another user could have put the library there
/// @throws std::runtime_error  MPI has started it, but the library cannot be loaded
std::unique_ptr<Transport> mpi_transport();

}  // namespace slideway
