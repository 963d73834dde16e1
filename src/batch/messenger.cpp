#include "slideway/batch/messenger.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace slideway {

// Variables that Open MPI, MPICH and Slurm's PMIx set in every process they start.
bool is_started_by_mpi() {
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"})
    if (std::getenv(variable) != nullptr) return true;
  return false;
}

std::unique_ptr<Messenger> find_messenger() {
  if (!is_started_by_mpi()) return nullptr;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
  const std::filesystem::path library =
      program.parent_path().parent_path() / "lib/slideway/libslideway_mpi.so";
  // Global: Open MPI loads parts of itself that look for the rest.
  void* const module = ::dlopen(library.c_str(), RTLD_NOW | RTLD_GLOBAL);
  void* const make = module == nullptr ? nullptr : ::dlsym(module, "slideway_make_messenger");
  if (make == nullptr)
    throw std::runtime_error(
        "started by MPI, but this slideway has none: " + std::string(::dlerror()) +
        "; accepted: a build where CMake finds MPI, or --shard i/n in as many processes");
  return std::unique_ptr<Messenger>(reinterpret_cast<Messenger* (*)()>(make)());
}

}  // namespace slideway
