// Preloaded before a program (LD_PRELOAD), makes one of its allocations fail: the one whose number, counted from the
// start of main, is in WISP_FAIL_AT; with WISP_FAIL_ON all after it too. Leaves how many there were in the file that
// WISP_COUNT_TO names. studies/hardening/faults.py does the rest.

#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

extern void* __libc_malloc(size_t);
extern void* __libc_calloc(size_t, size_t);
extern void* __libc_realloc(void*, size_t);
extern void* __libc_memalign(size_t, size_t);

static atomic_long counted, fail_at = -1;
static int counting, all_after;

static int fails(void) {
  if (!counting) return 0;
  const long number = atomic_fetch_add(&counted, 1);
  if (fail_at < 0 || number < fail_at || (number > fail_at && !all_after)) return 0;
  errno = ENOMEM;
  return 1;
}

void* malloc(size_t size) { return fails() ? NULL : __libc_malloc(size); }
void* calloc(size_t count, size_t size) { return fails() ? NULL : __libc_calloc(count, size); }
void* realloc(void* memory, size_t size) { return fails() ? NULL : __libc_realloc(memory, size); }
void* memalign(size_t alignment, size_t size) { return fails() ? NULL : __libc_memalign(alignment, size); }
void* aligned_alloc(size_t alignment, size_t size) { return fails() ? NULL : __libc_memalign(alignment, size); }
int posix_memalign(void** memory, size_t alignment, size_t size) {
  if (fails()) return ENOMEM;
  void* fresh = __libc_memalign(alignment, size);
  if (!fresh) return ENOMEM;
  *memory = fresh;
  return 0;
}

static void report(void) {
  counting = 0;
  const char* path = getenv("WISP_COUNT_TO");
  if (!path) return;
  char text[32];
  const int length = snprintf(text, sizeof text, "%ld\n", (long)counted);
  const int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (file >= 0) {
    if (write(file, text, (size_t)length) != length) _exit(99);
    close(file);
  }
}

static int (*real_main)(int, char**, char**);

static int counted_main(int argc, char** argv, char** environment) {
  const char* at = getenv("WISP_FAIL_AT");
  if (at) fail_at = atol(at);
  all_after = getenv("WISP_FAIL_ON") != NULL;
  atexit(report);
  counting = 1;
  return real_main(argc, argv, environment);
}

// What a program's first instructions call, and whom they give main to.
int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv, void (*init)(void), void (*fini)(void),
                      void (*rtld_fini)(void), void* stack_end) {
  real_main = main;
  int (*start)(int (*)(int, char**, char**), int, char**, void (*)(void), void (*)(void), void (*)(void), void*);
  *(void**)&start = dlsym(RTLD_NEXT, "__libc_start_main");
  return start(counted_main, argc, argv, init, fini, rtld_fini, stack_end);
}
