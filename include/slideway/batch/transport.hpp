#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace slideway {

/// Messages between processes that were started together, as mpirun and srun start them.
class Transport {
 public:
  struct Message {
    int from = 0;
    std::string text;
  };
  virtual ~Transport() = default;
  [[nodiscard]] virtual int rank() const = 0;  // of this process, 0 ... size - 1
  [[nodiscard]] virtual int size() const = 0;
  /// Returns when the text may be released, which can be as late as its receipt.
  virtual void send(int to, const std::string& text) = 0;
  /// The next message that has arrived, if any. Does not block.
  virtual std::optional<Message> receive() = 0;
};

/// Starts MPI. It is linked to a library of its own, loaded here, because loading MPI costs more
/// than identifying a profile.
/// @param library  libslideway_mpi.so
/// @throws std::runtime_error  the library cannot be loaded
std::unique_ptr<Transport> load_mpi_transport(const std::filesystem::path& library);

}  // namespace slideway
