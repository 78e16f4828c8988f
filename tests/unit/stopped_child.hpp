/// Work in a child process that is stopped at one of its system calls.
#pragma once

#include <signal.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <functional>

namespace tensegric_fit {

enum class Stop { kKill, kNoSpace };

/// Calls that a full disk can make fail.
inline bool may_lack_space(long call) {
  return call == SYS_write || call == SYS_fsync || call == SYS_openat || call == SYS_mkdirat ||
         call == SYS_renameat;
}

/// Runs the work in a child and stops it at its system call number `at`: killed before it, or without space
/// on the disk. False: the work had ended before.
inline bool stopped_at(int at, Stop stop, const std::function<void()>& work) {
  const pid_t child = fork();
  if (child == 0) {
    ptrace(PTRACE_TRACEME, 0, nullptr, nullptr);
    raise(SIGSTOP);
    work();
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ptrace(PTRACE_SETOPTIONS, child, nullptr, PTRACE_O_EXITKILL | PTRACE_O_TRACESYSGOOD);
  bool reached = false, failing = false;
  for (int stops = 0;; ++stops) {  // two per call: before and after it
    ptrace(PTRACE_SYSCALL, child, nullptr, nullptr);
    waitpid(child, &status, 0);
    if (!WIFSTOPPED(status)) return reached;
    if (stops == 2 * at && stop == Stop::kKill) {
      reached = true;
      kill(child, SIGKILL);
    }
#ifdef __x86_64__
    if (stop != Stop::kNoSpace || stops / 2 != at) continue;
    user_regs_struct registers{};
    ptrace(PTRACE_GETREGS, child, nullptr, &registers);
    if (stops % 2 == 0) {
      reached = true;
      failing = may_lack_space(static_cast<long>(registers.orig_rax));
      if (failing) registers.orig_rax = ~0ULL;  // no call
    } else if (failing) {
      registers.rax = static_cast<unsigned long long>(-ENOSPC);
    }
    ptrace(PTRACE_SETREGS, child, nullptr, &registers);
#else
    (void)failing;
#endif
  }
}

}  // namespace tensegric_fit
