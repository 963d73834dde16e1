#pragma once

#include <deque>

#include "slideway/batch/hands.hpp"
#include "slideway/batch/messenger.hpp"

namespace slideway {

/// The hands of all processes that were started together, for the one of rank 0, which has hands of
/// its own too. Work goes to whoever asks for it.
class Crew final : public Hands {
 public:
  Crew(Hands& own, Messenger& messenger);
  /// Sends the others home and waits until they have gone.
  ~Crew() override;
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  [[nodiscard]] bool has_idle() const override;
  void give(std::string task) override;
  [[nodiscard]] std::size_t busy() const override;
  std::vector<Answer> wait(std::chrono::milliseconds longest) override;

 private:
  Hands* own_;
  Messenger* messenger_;
  std::deque<int> asking_;  // ranks, once for each task they ask for
  std::size_t out_ = 0;     // tasks the others have
};

/// What the processes of the other ranks do: ask for tasks and send the answers, until rank 0 has
/// no more. @param ahead  tasks asked for at a time; one more than there are hands hides the way
void serve(Hands& own, Messenger& messenger, std::size_t ahead);

}  // namespace slideway
