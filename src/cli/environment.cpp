#include "environment.hpp"

#include <cstdlib>

namespace slideway {
namespace {

std::string variable(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace

std::optional<std::filesystem::path> data_directory(const std::string& option) {
  const std::string directory = option.empty() ? variable("SLIDEWAY_DATA") : option;
  if (directory.empty()) return std::nullopt;
  return directory;
}

// Variables that Open MPI, MPICH and Slurm's PMIx set in every process they start.
bool is_started_by_mpi() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"})
    if (!variable(name).empty()) return true;
  return false;
}

std::unique_ptr<Transport> mpi_transport() {
  if (!is_started_by_mpi()) return nullptr;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
  return load_mpi_transport(program.parent_path().parent_path() /
                            "lib/slideway/libslideway_mpi.so");
}

}  // namespace slideway
