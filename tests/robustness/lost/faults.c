/* Lets the n-th call that changes files under a directory fail, in processes of one name: an LD_PRELOAD library.
 *
 *   FAULT_UNDER   directory (absolute): only files below it count
 *   FAULT_NAME    name of the process: dem, xfem, python3 (the driver)
 *   FAULT_AT      n, from 1
 *   FAULT_CALL    errno to fail with, or: short (a write takes half of what it is given), again (a write, read or open is
 *                 interrupted once, EINTR), kill (the process ends by SIGKILL in front of the call; a write has written half)
 *   FAULT_STAYS   set: every later call fails as well, as on a disk that stays full (but for removing and closing)
 *   FAULT_LOG     file that gets a line for the fault: call and path
 * Counted: write, pwrite, fsync, fdatasync, rename, open where it may create, mkdir, ftruncate.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

enum { kNothing = 0, kFail, kShort, kAgain, kKill };

static long g_count = 0;
static int g_fired = 0;

static const char* setting(const char* name) {
  const char* value = getenv(name);
  return value && *value ? value : NULL;
}

static int is_below(const char* path) {
  const char* under = setting("FAULT_UNDER");
  char absolute[2 * PATH_MAX];
  if (!under || !path) return 0;
  if (path[0] != '/') {
    char here[PATH_MAX];
    if (!getcwd(here, sizeof(here))) return 0;
    snprintf(absolute, sizeof(absolute), "%s/%s", here, path);
    path = absolute;
  }
  const size_t length = strlen(under);
  return strncmp(path, under, length) == 0 && (path[length] == '/' || path[length] == 0);
}

static const char* path_of(int fd) {
  static __thread char path[PATH_MAX];
  char link[64];
  snprintf(link, sizeof(link), "/proc/self/fd/%d", fd);
  const ssize_t n = readlink(link, path, sizeof(path) - 1);
  if (n < 0) return NULL;
  path[n] = 0;
  return path;
}

static void record(const char* call, const char* path) {
  const char* log = setting("FAULT_LOG");
  if (!log) return;
  const int fd = REAL(open)(log, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (fd < 0) return;
  char line[PATH_MAX + 64];
  const int n = snprintf(line, sizeof(line), "%s %s\n", call, path);
  if (REAL(write)(fd, line, (size_t)n) != n) _exit(99);
  REAL(close)(fd);
}

/* What happens to this call; errno is set if it is to fail. */
static int fate(const char* call, const char* path) {
  const char* name = setting("FAULT_NAME");
  const char* at = setting("FAULT_AT");
  const char* how = setting("FAULT_CALL");
  if (!name || !at || !how || strcmp(name, program_invocation_short_name) != 0 || !is_below(path)) return kNothing;
  const long n = __atomic_add_fetch(&g_count, 1, __ATOMIC_SEQ_CST);
  if (n != atol(at) && !(n > atol(at) && setting("FAULT_STAYS"))) return kNothing;
  if (!g_fired) record(call, path);
  g_fired = 1;
  if (strcmp(how, "short") == 0) return kShort;
  if (strcmp(how, "again") == 0) {
    if (strcmp(call, "rename") == 0 || strcmp(call, "mkdir") == 0) return kNothing;  /* they never are */
    errno = EINTR;
    return kAgain;
  }
  if (strcmp(how, "kill") == 0) return kKill;
  errno = atoi(how);
  return kFail;
}

static void die(void) {
  raise(SIGKILL);
}

ssize_t write(int fd, const void* data, size_t size) {
  switch (fate("write", path_of(fd))) {
    case kFail:
    case kAgain:
      return -1;
    case kShort:
      return REAL(write)(fd, data, size > 1 ? size / 2 : size);
    case kKill:
      if (REAL(write)(fd, data, size / 2) >= -1) die();
  }
  return REAL(write)(fd, data, size);
}

#define FAILING(result_type, name, parameters, arguments, path) \
  result_type name parameters {                                 \
    switch (fate(#name, path)) {                                \
      case kFail:                                               \
      case kAgain:                                              \
        return -1;                                              \
      case kKill:                                               \
        die();                                                  \
    }                                                           \
    return REAL(name) arguments;                                \
  }

FAILING(ssize_t, pwrite, (int fd, const void* data, size_t size, off_t at), (fd, data, size, at), path_of(fd))
FAILING(int, rename, (const char* from, const char* to), (from, to), to)
FAILING(int, mkdir, (const char* path, mode_t mode), (path, mode), path)
FAILING(int, ftruncate, (int fd, off_t size), (fd, size), path_of(fd))
FAILING(int, ftruncate64, (int fd, off64_t size), (fd, size), path_of(fd))
FAILING(int, fsync, (int fd), (fd), path_of(fd))
FAILING(int, fdatasync, (int fd), (fd), path_of(fd))

static int opened(const char* call, const char* path, int flags) {
  if (!(flags & O_CREAT)) return kNothing;
  return fate(call, path);
}

#define OPENING(name)                                                    \
  int name(const char* path, int flags, ...) {                           \
    va_list rest;                                                        \
    va_start(rest, flags);                                               \
    const mode_t mode = flags & O_CREAT ? (mode_t)va_arg(rest, int) : 0; \
    va_end(rest);                                                        \
    switch (opened(#name, path, flags)) {                                \
      case kFail:                                                        \
      case kAgain:                                                       \
        return -1;                                                       \
      case kKill:                                                        \
        die();                                                           \
    }                                                                    \
    return REAL(name)(path, flags, mode);                                \
  }

OPENING(open)
OPENING(open64)
