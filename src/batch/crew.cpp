#include "slideway/batch/crew.hpp"

#include <utility>

namespace slideway {
namespace {

// What is said, by its first character: the others ask, answer, and say that they are gone; rank 0
// sends tasks and, in the end, sends them home.
constexpr char kAsks = '?', kAnswers = '!', kGone = '.', kTask = 't', kGoHome = 'x';

/// MPI tells nobody who sleeps; this often somebody looks.
constexpr std::chrono::milliseconds kLook{1};

std::string packed(const Answer& answer) {
  return kAnswers + answer.task + '\n' + answer.cause + '\n' + answer.reason + '\n' +
         answer.reply.value_or("");
}

Answer unpacked(std::string_view text) {
  const auto part = [&text] {
    const std::size_t newline = text.find('\n');
    std::string out(text.substr(0, newline));
    text.remove_prefix(newline + 1);
    return out;
  };
  Answer answer;
  text.remove_prefix(1);
  answer.task = part();
  answer.cause = part();
  answer.reason = part();
  if (answer.cause.empty()) answer.reply = std::string(text);
  return answer;
}

}  // namespace

Crew::Crew(Hands& own, Messenger& messenger) : own_(&own), messenger_(&messenger) {}

Crew::~Crew() {
  for (int rank = 1; rank < messenger_->size(); ++rank)
    messenger_->send(rank, std::string(1, kGoHome));
  for (int left = messenger_->size() - 1; left > 0;) {
    const auto message = messenger_->receive();
    if (!message)
      static_cast<void>(own_->wait(kLook));
    else if (message->text[0] == kGone)
      --left;
  }
}

bool Crew::has_idle() const { return own_->has_idle() || !asking_.empty(); }

void Crew::give(std::string task) {
  if (own_->has_idle()) return own_->give(std::move(task));
  messenger_->send(asking_.front(), kTask + task);
  asking_.pop_front();
  ++out_;
}

std::size_t Crew::busy() const { return own_->busy() + out_; }

std::vector<Answer> Crew::wait(std::chrono::milliseconds longest) {
  std::vector<Answer> answers = own_->wait(messenger_->size() > 1 ? kLook : longest);
  while (const auto message = messenger_->receive()) {
    if (message->text[0] == kAnswers) {
      answers.push_back(unpacked(message->text));
      --out_;
    }
    asking_.push_back(message->from);
  }
  return answers;
}

void serve(Hands& own, Messenger& messenger, std::size_t ahead) {
  std::deque<std::string> tasks;
  for (std::size_t i = 0; i < ahead; ++i) messenger.send(0, std::string(1, kAsks));
  for (;;) {
    while (!tasks.empty() && own.has_idle()) {
      own.give(std::move(tasks.front()));
      tasks.pop_front();
    }
    for (const Answer& answer : own.wait(kLook)) messenger.send(0, packed(answer));
    const auto message = messenger.receive();
    if (!message) continue;
    if (message->text[0] == kGoHome) break;
    tasks.push_back(message->text.substr(1));
  }
  messenger.send(0, std::string(1, kGone));
}

}  // namespace slideway
