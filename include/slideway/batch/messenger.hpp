#pragma once

#include <memory>
#include <optional>
#include <string>

namespace slideway {

/// The processes that were started together, as mpirun and srun do.
class Messenger {
 public:
  struct Message {
    int from = 0;
    std::string text;
  };
  virtual ~Messenger() = default;
  [[nodiscard]] virtual int rank() const = 0;  // of this process, 0 ... size - 1
  [[nodiscard]] virtual int size() const = 0;
  /// Returns when the text may be forgotten, which may take until it is received.
  virtual void send(int to, const std::string& text) = 0;
  /// A message that has come in, if there is one.
  virtual std::optional<Message> receive() = 0;
};

/// Whether mpirun, or srun with PMI, has started this process.
bool is_started_by_mpi();

/// The messenger of a process that MPI has started; nullptr for any other. It is in a library of
/// its own, ../lib/slideway/libslideway_mpi.so from the program on, loaded only then: MPI costs
/// more to load than a profile to identify.
/// @throws std::runtime_error  MPI has started it, but the library cannot be loaded
std::unique_ptr<Messenger> find_messenger();

}  // namespace slideway
