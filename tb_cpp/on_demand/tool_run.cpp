// SPDX-License-Identifier: Apache-2.0
#include "on_demand/tool_run.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/progress.hpp"

extern char** environ;

namespace dtof {
namespace {

constexpr std::size_t kMostOutput = 1U << 20U;
constexpr int kTickMilliseconds = 100;
constexpr int kSignalled = 128;

/// A child in a process group of its own, which ends with it.
class Child {
 public:
  explicit Child(pid_t pid) : pid_(pid) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  Child(Child&&) = delete;
  Child& operator=(Child&&) = delete;
  ~Child() {
    if (pid_ > 0) {
      kill(-pid_, SIGKILL);
      (void)wait();
    }
  }

  int wait() {
    int status = 0;
    while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : kSignalled + WTERMSIG(status);
  }

 private:
  pid_t pid_;
};

struct Pipe {
  std::array<int, 2> ends{-1, -1};

  Pipe() {
    if (pipe2(ends.data(), O_CLOEXEC) != 0) {
      throw InputError(fmt::format("cannot run a program: {}", std::strerror(errno)));
    }
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  Pipe(Pipe&&) = delete;
  Pipe& operator=(Pipe&&) = delete;
  ~Pipe() {
    for (int& end : ends) {
      close_end(end);
    }
  }
  static void close_end(int& end) {
    if (end >= 0) {
      close(end);
      end = -1;
    }
  }
};

/// 0, or why the program did not start.
int spawn(std::span<const std::string> command, const std::filesystem::path& folder, int output, pid_t& pid) {
  std::vector<char*> arguments;
  for (const std::string& word : command) {
    arguments.push_back(const_cast<char*>(word.c_str()));  // posix_spawnp changes none
  }
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output, STDERR_FILENO);
  if (!folder.empty()) {
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  }
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  posix_spawnattr_setpgroup(&attributes, 0);
  sigset_t defaults;
  sigemptyset(&defaults);
  sigaddset(&defaults, SIGINT);
  sigaddset(&defaults, SIGTERM);
  sigaddset(&defaults, SIGPIPE);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  const int reason = posix_spawnp(&pid, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return reason;
}

}  // namespace

std::optional<ToolRun> run_tool(std::span<const std::string> command, const std::filesystem::path& folder,
                                const std::function<void()>& tick) {
  Pipe pipe;
  pid_t pid = 0;
  const int reason = spawn(command, folder, pipe.ends[1], pid);
  if (reason == ENOENT || reason == ENOTDIR || reason == EACCES) {
    return std::nullopt;
  }
  if (reason != 0) {
    throw InputError(fmt::format("cannot run {}: {}", command.front(), std::strerror(reason)));
  }
  Child child(pid);
  Pipe::close_end(pipe.ends[1]);
  ToolRun run;
  for (std::array<char, 4096> bytes{};;) {
    check_interruption();
    pollfd waiting{.fd = pipe.ends[0], .events = POLLIN, .revents = 0};
    const int ready = poll(&waiting, 1, kTickMilliseconds);
    if (tick) {
      tick();
    }
    if (ready <= 0) {
      continue;
    }
    const ssize_t count = read(pipe.ends[0], bytes.data(), bytes.size());
    if (count == 0 || (count < 0 && errno != EINTR)) {
      break;
    }
    if (count > 0 && run.output.size() < kMostOutput) {
      run.output.append(bytes.data(), static_cast<std::size_t>(count));
    }
  }
  run.exit_code = child.wait();
  return run;
}

}  // namespace dtof
