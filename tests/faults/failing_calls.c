/* Preloaded before a program under test: of one function of the C library the n-th call after
 * main() began fails, once, with an error that is documented for it.
 *
 * FAILING_CALL="write:3"  the third write() fails; "write:0": none does
 * FAILING_COUNT=FILE      how many calls there were, of the first process, is written there
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

static char function[32];
static long number;
static atomic_long calls;
static atomic_int armed;
static pid_t first_process;

/* Whether this call is the one. */
static int fails(const char* name) {
  if (!atomic_load(&armed) || strcmp(name, function) != 0) return 0;
  return atomic_fetch_add(&calls, 1) + 1 == number;
}

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

#define FAILING(type, name, parameters, arguments, error, result)  \
  type name parameters {                                           \
    static type(*real) parameters;                                 \
    if (!real) real = (type(*) parameters)dlsym(RTLD_NEXT, #name); \
    if (fails(#name)) {                                            \
      errno = error;                                               \
      return result;                                               \
    }                                                              \
    return real arguments;                                         \
  }

FAILING(ssize_t, read, (int file, void* to, size_t size), (file, to, size), EIO, -1)
FAILING(ssize_t, write, (int file, const void* from, size_t size), (file, from, size), ENOSPC, -1)
FAILING(ssize_t, writev, (int file, const struct iovec* parts, int count), (file, parts, count),
        ENOSPC, -1)
FAILING(int, close, (int file), (file), EIO, -1)
FAILING(int, fsync, (int file), (file), EIO, -1)
FAILING(int, rename, (const char* from, const char* to), (from, to), EIO, -1)
FAILING(int, linkat, (int a, const char* from, int b, const char* to, int flags),
        (a, from, b, to, flags), ENOSPC, -1)
FAILING(int, mkdir, (const char* path, mode_t mode), (path, mode), ENOSPC, -1)
FAILING(pid_t, fork, (void), (), EAGAIN, -1)
FAILING(int, pipe2, (int ends[2], int flags), (ends, flags), EMFILE, -1)
FAILING(FILE*, fopen, (const char* path, const char* mode), (path, mode), EMFILE, NULL)
FAILING(FILE*, fopen64, (const char* path, const char* mode), (path, mode), EMFILE, NULL)
FAILING(int, fstat, (int file, struct stat* status), (file, status), EIO, -1)
FAILING(void*, mmap, (void* at, size_t size, int access, int flags, int file, off_t from),
        (at, size, access, flags, file, from), ENOMEM, MAP_FAILED)
FAILING(int, pthread_create,
        (pthread_t * thread, const pthread_attr_t* attributes, void* (*run)(void*), void* with),
        (thread, attributes, run, with), EAGAIN, EAGAIN)

int open(const char* path, int flags, ...) {
  static int (*real)(const char*, int, ...);
  if (!real) real = (int (*)(const char*, int, ...))dlsym(RTLD_NEXT, "open");
  va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) ? va_arg(more, mode_t) : 0;
  va_end(more);
  if (fails("open")) {
    errno = EMFILE;
    return -1;
  }
  return real(path, flags, mode);
}

/* The wall clock goes back by an hour from the n-th look on. */
int clock_gettime(clockid_t clock, struct timespec* now) {
  static int (*real)(clockid_t, struct timespec*);
  static atomic_int back;
  if (!real) real = (int (*)(clockid_t, struct timespec*))dlsym(RTLD_NEXT, "clock_gettime");
  const int result = real(clock, now);
  if (clock == CLOCK_REALTIME) {
    if (fails("clock_gettime")) atomic_store(&back, 1);
    if (atomic_load(&back)) now->tv_sec -= 3600;
  }
  return result;
}

/* Memory: through the C library's own names, since dlsym() itself may allocate. */
extern void* __libc_malloc(size_t);
extern void* __libc_calloc(size_t, size_t);
extern void* __libc_realloc(void*, size_t);
extern void* __libc_memalign(size_t, size_t);

static void* none(void) {
  errno = ENOMEM;
  return NULL;
}

void* malloc(size_t size) { return fails("malloc") ? none() : __libc_malloc(size); }
void* calloc(size_t count, size_t size) {
  return fails("malloc") ? none() : __libc_calloc(count, size);
}
void* realloc(void* old, size_t size) {
  return fails("malloc") ? none() : __libc_realloc(old, size);
}
void* aligned_alloc(size_t align, size_t size) {
  return fails("malloc") ? none() : __libc_memalign(align, size);
}
int posix_memalign(void** out, size_t align, size_t size) {
  if (fails("malloc")) return ENOMEM;
  *out = __libc_memalign(align, size);
  return *out ? 0 : ENOMEM;
}

static void count(void) {
  atomic_store(&armed, 0);
  const char* const path = getenv("FAILING_COUNT");
  if (!path || getpid() != first_process) return;
  FILE* const file = fopen(path, "w");
  if (!file) return;
  fprintf(file, "%ld\n", atomic_load(&calls));
  fclose(file);
}

static int (*real_main)(int, char**, char**);

static int counted_main(int count_of, char** arguments, char** environment) {
  first_process = getpid();
  const char* const call = getenv("FAILING_CALL");
  if (call) sscanf(call, "%31[a-z0-9_]:%ld", function, &number);
  atomic_store(&armed, 1);
  const int result = real_main(count_of, arguments, environment);
  count();
  return result;
}

int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv,
                      int (*init)(int, char**, char**), void (*fini)(void), void (*rtld_fini)(void),
                      void* stack_end) {
  real_main = main;
  const __typeof__(&__libc_start_main) real =
      (__typeof__(&__libc_start_main))dlsym(RTLD_NEXT, "__libc_start_main");
  return real(counted_main, argc, argv, init, fini, rtld_fini, stack_end);
}
