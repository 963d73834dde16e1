#include "slideway/batch/distributed_pool.hpp"

#include <utility>

namespace slideway {
namespace {

// The first character of a message. From the other ranks: request, result, stopped; from rank 0:
// task, stop.
constexpr char kRequest = '?', kResult = '!', kStopped = '.', kTask = 't', kStop = 'x';

/// MPI has no blocking receive with a timeout.
constexpr std::chrono::milliseconds kPollInterval{1};

std::string packed(const TaskResult& result) {
  return kResult + result.task + '\n' + result.cause + '\n' + result.reason + '\n' +
         result.reply.value_or("");
}

TaskResult unpacked(std::string_view text) {
  const auto part = [&text] {
    const std::size_t newline = text.find('\n');
    std::string out(text.substr(0, newline));
    text.remove_prefix(newline + 1);
    return out;
  };
  TaskResult result;
  text.remove_prefix(1);
  result.task = part();
  result.cause = part();
  result.reason = part();
  if (result.cause.empty()) result.reply = std::string(text);
  return result;
}

}  // namespace

DistributedPool::DistributedPool(TaskPool& local, Transport& transport)
    : local_(&local), transport_(&transport) {}

DistributedPool::~DistributedPool() {
  for (int rank = 1; rank < transport_->size(); ++rank)
    transport_->send(rank, std::string(1, kStop));
  for (int running = transport_->size() - 1; running > 0;) {
    const auto message = transport_->receive();
    if (!message)
      static_cast<void>(local_->collect(kPollInterval));
    else if (message->text[0] == kStopped)
      --running;
  }
}

bool DistributedPool::has_idle() const { return local_->has_idle() || !requests_.empty(); }

void DistributedPool::submit(std::string task) {
  if (local_->has_idle()) return local_->submit(std::move(task));
  transport_->send(requests_.front(), kTask + task);
  requests_.pop_front();
  ++remote_;
}

std::size_t DistributedPool::pending() const { return local_->pending() + remote_; }

std::vector<TaskResult> DistributedPool::collect(std::chrono::milliseconds timeout) {
  std::vector<TaskResult> results =
      local_->collect(transport_->size() > 1 ? kPollInterval : timeout);
  while (const auto message = transport_->receive()) {
    if (message->text[0] == kResult) {
      results.push_back(unpacked(message->text));
      --remote_;
    }
    requests_.push_back(message->from);
  }
  return results;
}

void serve_tasks(TaskPool& local, Transport& transport, std::size_t prefetch) {
  std::deque<std::string> tasks;
  for (std::size_t i = 0; i < prefetch; ++i) transport.send(0, std::string(1, kRequest));
  for (;;) {
    while (!tasks.empty() && local.has_idle()) {
      local.submit(std::move(tasks.front()));
      tasks.pop_front();
    }
    for (const TaskResult& result : local.collect(kPollInterval)) transport.send(0, packed(result));
    const auto message = transport.receive();
    if (!message) continue;
    if (message->text[0] == kStop) break;
    tasks.push_back(message->text.substr(1));
  }
  transport.send(0, std::string(1, kStopped));
}

}  // namespace slideway
