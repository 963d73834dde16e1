#include "slideway/batch/transport.hpp"

#include <dlfcn.h>

#include <stdexcept>

namespace slideway {

std::unique_ptr<Transport> load_mpi_transport(const std::filesystem::path& library) {
  // RTLD_GLOBAL: Open MPI loads plugins that need its symbols.
  void* const module = ::dlopen(library.c_str(), RTLD_NOW | RTLD_GLOBAL);
  void* const make = module == nullptr ? nullptr : ::dlsym(module, "slideway_make_transport");
  if (make == nullptr)
    throw std::runtime_error(
        "started by MPI, but this slideway has none: " + std::string(::dlerror()) +
        "; accepted: a build where CMake finds MPI, or --shard i/n in as many processes");
  return std::unique_ptr<Transport>(reinterpret_cast<Transport* (*)()>(make)());
}

}  // namespace slideway
