/* Preloaded before a program under test: of one function of the C library the n-th call after
 * main() began fails, once, with an error that is documented for it.
 *
 * FAILING_CALL="write:3"  the third write() fails; "write:0": none does
 * FAILING_CALL="bytes:3"  the disk is full from the third byte on that goes into a regular file
 * FAILING_CALL="torn:3"   the same, and no file can be cut to another length
 * FAILING_FILE=FILE       every read() of it fails
 * FAILING_COUNT=FILE      how many calls (bytes) there were, of the first process, is written there
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
#include <sys/sendfile.h>
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
static int fills;            /* the disk */
static struct stat bad_file; /* st_ino 0: none */

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

static int status_of(int file, struct stat* status) {
  static int (*real)(int, struct stat*);
  if (!real) real = (int (*)(int, struct stat*))dlsym(RTLD_NEXT, "fstat");
  return real(file, status);
}

/* How many of so many bytes the disk takes. */
static size_t room_for(int file, size_t size) {
  struct stat status;
  if (!atomic_load(&armed) || !fills || status_of(file, &status) != 0 || !S_ISREG(status.st_mode))
    return size;
  const long before = atomic_fetch_add(&calls, (long)size), room = number - 1 - before;
  return number == 0 || room >= (long)size ? size : room > 0 ? (size_t)room : 0;
}

static ssize_t disk_is_full(void) {
  errno = ENOSPC;
  return -1;
}

ssize_t write(int file, const void* from, size_t size) {
  static ssize_t (*real)(int, const void*, size_t);
  if (!real) real = (ssize_t(*)(int, const void*, size_t))dlsym(RTLD_NEXT, "write");
  const size_t room = room_for(file, size);
  return fails("write") || (room == 0 && size > 0) ? disk_is_full() : real(file, from, room);
}

ssize_t pwrite(int file, const void* from, size_t size, off_t at) {
  static ssize_t (*real)(int, const void*, size_t, off_t);
  if (!real) real = (ssize_t(*)(int, const void*, size_t, off_t))dlsym(RTLD_NEXT, "pwrite");
  const size_t room = room_for(file, size);
  return fails("write") || (room == 0 && size > 0) ? disk_is_full() : real(file, from, room, at);
}

ssize_t sendfile(int to, int from, off_t* at, size_t size) {
  static ssize_t (*real)(int, int, off_t*, size_t);
  if (!real) real = (ssize_t(*)(int, int, off_t*, size_t))dlsym(RTLD_NEXT, "sendfile");
  const size_t room = room_for(to, size);
  return room == 0 && size > 0 ? disk_is_full() : real(to, from, at, room);
}

/* A short one writes the parts that fit whole, or some of the first. */
ssize_t writev(int file, const struct iovec* parts, int count) {
  static ssize_t (*real)(int, const struct iovec*, int);
  if (!real) real = (ssize_t(*)(int, const struct iovec*, int))dlsym(RTLD_NEXT, "writev");
  if (fails("writev")) return disk_is_full();
  size_t size = 0;
  for (int i = 0; i < count; ++i) size += parts[i].iov_len;
  size_t room = room_for(file, size);
  if (room == size) return real(file, parts, count);
  int whole = 0;
  while (parts[whole].iov_len <= room) room -= parts[whole++].iov_len;
  if (whole > 0) return real(file, parts, whole);
  const struct iovec first = {parts[0].iov_base, room};
  return room == 0 ? disk_is_full() : real(file, &first, 1);
}

int ftruncate(int file, off_t size) {
  static int (*real)(int, off_t);
  if (!real) real = (int (*)(int, off_t))dlsym(RTLD_NEXT, "ftruncate");
  if (!fails("ftruncate") && (!atomic_load(&armed) || strcmp(function, "torn") != 0))
    return real(file, size);
  errno = EIO;
  return -1;
}

ssize_t read(int file, void* to, size_t size) {
  static ssize_t (*real)(int, void*, size_t);
  if (!real) real = (ssize_t(*)(int, void*, size_t))dlsym(RTLD_NEXT, "read");
  struct stat status;
  const int is_bad = atomic_load(&armed) && bad_file.st_ino != 0 && status_of(file, &status) == 0 &&
                     status.st_dev == bad_file.st_dev && status.st_ino == bad_file.st_ino;
  if (!is_bad && !fails("read")) return real(file, to, size);
  errno = EIO;
  return -1;
}

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
  fills = !strcmp(function, "bytes") || !strcmp(function, "torn");
  const char* const bad = getenv("FAILING_FILE");
  if (bad && stat(bad, &bad_file) != 0) bad_file.st_ino = 0;
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
