#include "slideway/batch/process_pool.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iostream>
#include <map>
#include <new>
#include <thread>

#include "slideway/base/sanitizer.hpp"
#include "slideway/batch/item.hpp"

namespace slideway::process_pool_test {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

/// The results of these tasks, by task.
std::map<std::string, TaskResult> results_of(TaskPool& pool,
                                             const std::vector<std::string>& tasks) {
  std::map<std::string, TaskResult> out;
  for (auto next = tasks.begin(); next != tasks.end() || pool.pending() > 0;) {
    while (next != tasks.end() && pool.has_idle()) pool.submit(*next++);
    for (TaskResult& result : pool.collect(milliseconds(1000))) {
      std::string task = result.task;
      out.emplace(std::move(task), std::move(result));
    }
  }
  return out;
}

std::string work(const std::string& task) {
  if (task == "crash") std::raise(SIGSEGV);
  if (task == "leave") ::_exit(7);
  if (task == "sleep") std::this_thread::sleep_for(std::chrono::hours(1));
  if (task == "long") return std::string(10'000'000, 'x');
  if (task == "process") return std::to_string(::getpid());
  return "did " + task;
}

TEST(ProcessPool, EveryTaskHasOneResult) {
  for (const std::size_t count : {1U, 2U, 5U}) {
    ProcessPool workers(count, work, {});
    std::vector<std::string> tasks;
    for (int i = 0; i < 300; ++i) tasks.push_back(std::to_string(i));
    const auto done = results_of(workers, tasks);
    ASSERT_EQ(done.size(), tasks.size());
    for (const auto& [task, result] : done) EXPECT_EQ(result.reply, "did " + task);
  }
}

TEST(ProcessPool, RepliesMayBeLong) {
  ProcessPool workers(2, work, {});
  EXPECT_EQ(results_of(workers, {"long", "a"}).at("long").reply, std::string(10'000'000, 'x'));
}

TEST(ProcessPool, ACrashIsAResultAndChangesNoOther) {
  ProcessPool workers(2, work, {});
  const auto done = results_of(workers, {"a", "crash", "b", "leave", "c", "d"});
  EXPECT_FALSE(done.at("crash").reply);
  EXPECT_EQ(done.at("crash").cause, status::kCrashed);
  EXPECT_EQ(done.at("leave").reason, "ended with exit code 7");
  for (const char* task : {"a", "b", "c", "d"})
    EXPECT_EQ(done.at(task).reply, std::string("did ") + task);
}

TEST(ProcessPool, WhatTakesTooLongIsEnded) {
  ProcessPool workers(2, work, {.time = milliseconds(200)});
  const auto done = results_of(workers, {"a", "sleep", "b", "c"});
  EXPECT_EQ(done.at("sleep").cause, status::kTimeout);
  EXPECT_EQ(done.at("sleep").reason, "took longer than 0.2 s");
  EXPECT_EQ(done.at("c").reply, "did c");
}

TEST(ProcessPool, OneThatWasEndedWhileIdleIsReplaced) {
  ProcessPool workers(1, work, {});
  const pid_t process = std::stoi(*results_of(workers, {"process"}).at("process").reply);
  ::kill(process, SIGKILL);
  std::this_thread::sleep_for(milliseconds(100));
  EXPECT_EQ(results_of(workers, {"a"}).at("a").reply, "did a");
}

TEST(ProcessPool, MemoryIsLimited) {
  if (kHasShadow) GTEST_SKIP() << "the shadow of a sanitizer is beyond any limit";
  const auto greedy = [](const std::string& task) {
    try {
      return std::to_string(std::string(std::stoul(task), 'x').size());
    } catch (const std::bad_alloc&) {
      return std::string("no");
    }
  };
  ProcessPool workers(1, greedy, {.memory_bytes = 300'000'000});
  const auto done = results_of(workers, {"1000000000", "1000"});
  EXPECT_EQ(done.at("1000000000").reply, "no");
  EXPECT_EQ(done.at("1000").reply, "1000");
}

TEST(ProcessPool, MoreWorkersThanOpenFilesAreRefused) {
  const auto refusal = [] {
    const rlimit limit{64, 64};
    ::setrlimit(RLIMIT_NOFILE, &limit);
    try {
      const ProcessPool workers(100, work, {});
    } catch (const std::runtime_error& error) {
      std::cerr << error.what();
      ::_exit(1);
    }
    ::_exit(0);
  };
  EXPECT_EXIT(refusal(), testing::ExitedWithCode(1),
              "100 worker processes need 132 open files; the system allows 64 \\(ulimit -n\\)");
}

TEST(ProcessPool, EndWithTheirParent) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t parent = ::fork();
  if (parent == 0) {
    ProcessPool workers(1, work, {});
    workers.submit("process");
    const std::vector<TaskResult> done = workers.collect(milliseconds(1000));
    const pid_t worker = std::stoi(*done.at(0).reply);
    workers.submit("sleep");
    static_cast<void>(!::write(ends[1], &worker, sizeof worker));
    ::kill(::getpid(), SIGKILL);
  }
  pid_t worker = 0;
  ASSERT_EQ(::read(ends[0], &worker, sizeof worker), static_cast<ssize_t>(sizeof worker));
  int status = 0;
  ::waitpid(parent, &status, 0);
  const auto is_there = [&] { return ::kill(worker, 0) == 0; };
  for (int i = 0; i < 100 && is_there(); ++i) std::this_thread::sleep_for(milliseconds(20));
  // A zombie of init's may stay where nobody waits for it; it does nothing any more.
  if (is_there()) {
    std::ifstream stat("/proc/" + std::to_string(worker) + "/stat");
    std::string line;
    std::getline(stat, line);
    EXPECT_THAT(line, HasSubstr(") Z "));
  }
  ::close(ends[0]);
  ::close(ends[1]);
}

}  // namespace
}  // namespace slideway::process_pool_test
