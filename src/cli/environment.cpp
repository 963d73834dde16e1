#include "environment.hpp"

#include <sys/stat.h>

#include <cstdlib>

#include "slideway/base/error.hpp"

namespace slideway {
namespace {

std::string variable(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// What lies beside the program is code of whoever put it there: it must be of those whom the
/// program itself is trusted to.
void require_trusted(const std::filesystem::path& path, const std::filesystem::path& program) {
  struct stat own = {};
  struct stat of_program = {};
  if (::stat(path.c_str(), &own) != 0 || ::stat(program.c_str(), &of_program) != 0) return;
  if ((own.st_uid == 0 || own.st_uid == of_program.st_uid) && (own.st_mode & S_IWOTH) == 0) return;
  throw UsageError("started by MPI, but " + path.string() +
                   " is of another user, or all may write it; accepted: of the owner of " +
                   program.string() + " or of root, and written by nobody else");
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
  const std::filesystem::path folder = program.parent_path().parent_path() / "lib/slideway";
  const std::filesystem::path library = folder / "libslideway_mpi.so";
  for (const std::filesystem::path& each : {folder.parent_path(), folder, library})
    require_trusted(each, program);
  return load_mpi_transport(library);
}

}  // namespace slideway
