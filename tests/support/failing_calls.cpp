// SPDX-License-Identifier: BSD-3-Clause
// Preloaded into a program (LD_PRELOAD), makes calls of one kind fail, as a full disk or a folder without permission
// does:
//
//   FAILING_KIND    open (for writing), write, fsync, rename, mkdir, flock; of files below FAILING_UNDER; or malloc; or
//                   clock: the calendar then jumps back by a year, and forth, at each call
//   FAILING_AT      number of the first call that fails, counted from 1; 0: none
//   FAILING_CALLS   how many fail from there on; left out: all
//   FAILING_CODE    errno, ENOSPC if left out
//   FAILING_PROGRAM name of the program that is meant, not those that it starts
//   FAILING_COUNT   a file that gets the number of calls when the program ends
//
// Used by tests/apps/failures_test.py.
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

// What glibc has beneath its own malloc and the others.
extern "C" void *__libc_malloc(size_t), *__libc_calloc(size_t, size_t), *__libc_realloc(void *, size_t),
    *__libc_memalign(size_t, size_t);

namespace
{
std::atomic<long> calls{0};

struct Plan
{
  const char *kind = "", *under = "", *count = nullptr;
  long at = 0, last = LONG_MAX;
  int code = ENOSPC;
};
Plan plan;
bool is_planned = false, planned = false; ///< for this program; from now on
int (*own_main)(int, char **, char **);

long number(const char *name, long otherwise)
{
  const char *text = std::getenv(name);
  return text ? std::atol(text) : otherwise;
}

__attribute__((constructor)) void read_plan()
{
  if (const char *kind = std::getenv("FAILING_KIND"))
    plan.kind = kind;
  if (const char *under = std::getenv("FAILING_UNDER"))
    plan.under = under;
  plan.count = std::getenv("FAILING_COUNT");
  plan.at = number("FAILING_AT", 0);
  if (const long n = number("FAILING_CALLS", 0); n > 0)
    plan.last = plan.at + n - 1;
  plan.code = static_cast<int>(number("FAILING_CODE", ENOSPC));
  const char *program = std::getenv("FAILING_PROGRAM");
  is_planned = *plan.kind != 0 && program && std::strcmp(program, program_invocation_short_name) == 0;
}

__attribute__((destructor)) void write_count()
{
  if (!planned || !plan.count)
    return;
  planned = false;
  if (const int file = ::creat(plan.count, 0644); file >= 0)
    {
      ::dprintf(file, "%ld\n", calls.load());
      ::close(file);
    }
}

/// Counts a call, and says whether it fails.
bool fails()
{
  const long n = ++calls;
  if (plan.at == 0 || n < plan.at || n > plan.last)
    return false;
  errno = plan.code;
  return true;
}

bool is_meant(const char *kind) { return planned && std::strcmp(kind, plan.kind) == 0; }

bool fails(const char *kind, const char *path)
{
  if (!is_meant(kind))
    return false;
  char absolute[2 * PATH_MAX] = "";
  if (path[0] != '/' && getcwd(absolute, PATH_MAX))
    std::strcat(absolute, "/");
  std::strncat(absolute, path, PATH_MAX - 1);
  return std::strncmp(absolute, plan.under, std::strlen(plan.under)) == 0 && fails();
}

bool fails(const char *kind, int descriptor)
{
  if (!is_meant(kind))
    return false;
  char link[64], path[PATH_MAX];
  std::snprintf(link, sizeof(link), "/proc/self/fd/%d", descriptor);
  const ssize_t length = readlink(link, path, sizeof(path) - 1);
  if (length <= 0)
    return false;
  path[length] = 0;
  return path[0] == '/' && fails(kind, path);
}

template <typename Function>
Function next(Function, const char *name)
{
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}
} // namespace

#define ISOSTAT_NEXT(name) static const auto original = next(&name, #name)

extern "C"
{
// What is needed before the program itself begins does not fail.
int __libc_start_main(int (*program)(int, char **, char **), int argc, char **argv, void (*init)(), void (*fini)(),
                      void (*unload)(), void *stack_end)
{
  ISOSTAT_NEXT(__libc_start_main);
  own_main = program;
  const auto begin = [](int n, char **arguments, char **environment) {
    planned = is_planned;
    return own_main(n, arguments, environment);
  };
  return original(begin, argc, argv, init, fini, unload, stack_end);
}
int open(const char *path, int flags, ...)
{
  std::va_list list;
  va_start(list, flags);
  const mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(list, mode_t) : 0;
  va_end(list);
  ISOSTAT_NEXT(open);
  return (flags & O_ACCMODE) != O_RDONLY && fails("open", path) ? -1 : original(path, flags, mode);
}
std::FILE *fopen(const char *path, const char *mode)
{
  ISOSTAT_NEXT(fopen);
  return std::strpbrk(mode, "wa+") && fails("open", path) ? nullptr : original(path, mode);
}
ssize_t write(int descriptor, const void *bytes, size_t n)
{
  ISOSTAT_NEXT(write);
  return fails("write", descriptor) ? -1 : original(descriptor, bytes, n);
}
ssize_t pwrite(int descriptor, const void *bytes, size_t n, off_t at)
{
  ISOSTAT_NEXT(pwrite);
  return fails("write", descriptor) ? -1 : original(descriptor, bytes, n, at);
}
ssize_t writev(int descriptor, const struct iovec *parts, int n)
{
  ISOSTAT_NEXT(writev);
  return fails("write", descriptor) ? -1 : original(descriptor, parts, n);
}
int fsync(int descriptor)
{
  ISOSTAT_NEXT(fsync);
  return fails("fsync", descriptor) ? -1 : original(descriptor);
}
int flock(int descriptor, int how)
{
  ISOSTAT_NEXT(flock);
  return fails("flock", descriptor) ? -1 : original(descriptor, how);
}
void *malloc(size_t n) { return (is_meant("malloc") && fails()) ? nullptr : __libc_malloc(n); }
void *calloc(size_t n, size_t size) { return (is_meant("malloc") && fails()) ? nullptr : __libc_calloc(n, size); }
void *realloc(void *old, size_t n) { return (is_meant("malloc") && fails()) ? nullptr : __libc_realloc(old, n); }
void *memalign(size_t alignment, size_t n)
{
  return (is_meant("malloc") && fails()) ? nullptr : __libc_memalign(alignment, n);
}
void *aligned_alloc(size_t alignment, size_t n) { return memalign(alignment, n); }
int posix_memalign(void **result, size_t alignment, size_t n)
{
  *result = memalign(alignment, n);
  return *result ? 0 : ENOMEM;
}
int clock_gettime(clockid_t clock, struct timespec *now)
{
  ISOSTAT_NEXT(clock_gettime);
  const int result = original(clock, now);
  if (clock == CLOCK_REALTIME && is_meant("clock") && fails())
    now->tv_sec -= (calls % 2) * 31'557'600;
  return result;
}
time_t time(time_t *out)
{
  struct timespec now = {};
  clock_gettime(CLOCK_REALTIME, &now);
  if (out)
    *out = now.tv_sec;
  return now.tv_sec;
}
int rename(const char *from, const char *to)
{
  ISOSTAT_NEXT(rename);
  return fails("rename", to) ? -1 : original(from, to);
}
int mkdir(const char *path, mode_t mode)
{
  ISOSTAT_NEXT(mkdir);
  return fails("mkdir", path) ? -1 : original(path, mode);
}
// Offsets have 64 bits anyway.
int open64(const char *path, int flags, ...) __attribute__((alias("open")));
std::FILE *fopen64(const char *path, const char *mode) __attribute__((alias("fopen")));
ssize_t pwrite64(int descriptor, const void *bytes, size_t n, off64_t at) __attribute__((alias("pwrite")));
}
