// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// For LD_PRELOAD: the system refuses one thing, once. REFUSE names the function, REFUSE_AT which of its calls by code of
// this project, counted from 1, and REFUSE_HIT a file that is made when that call came. A call by the C++ library counts
// as one of this project.
#undef _FILE_OFFSET_BITS  // with which open and open64 would be one function
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

static atomic_int calls;

static int is_ours(void* caller) {
  Dl_info info;
  if (!dladdr(caller, &info) || !info.dli_fname) return 0;
  const char* slash = strrchr(info.dli_fname, '/');
  const char* name = slash ? slash + 1 : info.dli_fname;
  return strstr(name, "spidar") || strstr(name, "libstdc++");
}

static int refuses(const char* function, void* caller) {
  const char* wanted = getenv("REFUSE");
  if (!wanted || strcmp(wanted, function) != 0 || !is_ours(caller)) return 0;
  const char* at = getenv("REFUSE_AT");
  if (atomic_fetch_add(&calls, 1) + 1 != (at ? atoi(at) : 1)) return 0;
  const char* hit = getenv("REFUSE_HIT");
  if (hit) syscall(SYS_close, (int)syscall(SYS_openat, AT_FDCWD, hit, O_CREAT | O_WRONLY, 0600));
  return 1;
}

// The function of the same name that would have been called.
#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))
#define REFUSE(name, error, result)                          \
  if (refuses(#name, __builtin_return_address(0))) {         \
    errno = error;                                           \
    return result;                                           \
  }

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*), void* argument) {
  if (refuses("pthread_create", __builtin_return_address(0))) return EAGAIN;
  return NEXT(pthread_create)(thread, attributes, run, argument);
}

static int mode_of(int flags, va_list list) {
  return flags & (O_CREAT | __O_TMPFILE) ? va_arg(list, int) : 0;
}

int open(const char* path, int flags, ...) {
  REFUSE(open, EMFILE, -1)
  va_list list;
  va_start(list, flags);
  const int mode = mode_of(flags, list);
  va_end(list);
  return NEXT(open)(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  if (refuses("open", __builtin_return_address(0))) {
    errno = EMFILE;
    return -1;
  }
  va_list list;
  va_start(list, flags);
  const int mode = mode_of(flags, list);
  va_end(list);
  return NEXT(open64)(path, flags, mode);
}

FILE* fopen(const char* path, const char* mode) {
  REFUSE(fopen, EMFILE, NULL)
  return NEXT(fopen)(path, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  if (refuses("fopen", __builtin_return_address(0))) {
    errno = EMFILE;
    return NULL;
  }
  return NEXT(fopen64)(path, mode);
}

void* mmap(void* address, size_t length, int protection, int flags, int descriptor, off_t offset) {
  REFUSE(mmap, ENOMEM, MAP_FAILED)
  return (void*)syscall(SYS_mmap, address, length, protection, flags, descriptor, offset);
}

int socket(int domain, int type, int protocol) {
  REFUSE(socket, EMFILE, -1)
  return NEXT(socket)(domain, type, protocol);
}

int socketpair(int domain, int type, int protocol, int ends[2]) {
  REFUSE(socketpair, EMFILE, -1)
  return NEXT(socketpair)(domain, type, protocol, ends);
}

int eventfd(unsigned int value, int flags) {
  REFUSE(eventfd, EMFILE, -1)
  return NEXT(eventfd)(value, flags);
}

int memfd_create(const char* name, unsigned int flags) {
  REFUSE(memfd_create, EMFILE, -1)
  return NEXT(memfd_create)(name, flags);
}

int pipe2(int ends[2], int flags) {
  REFUSE(pipe2, EMFILE, -1)
  return NEXT(pipe2)(ends, flags);
}

void* dlopen(const char* file, int flags) {
  REFUSE(dlopen, ENOMEM, NULL)
  return NEXT(dlopen)(file, flags);
}

pid_t fork(void) {
  REFUSE(fork, EAGAIN, -1)
  return NEXT(fork)();
}

int posix_spawn(pid_t* process, const char* path, const posix_spawn_file_actions_t* actions,
                const posix_spawnattr_t* attributes, char* const arguments[], char* const environment[]) {
  if (refuses("posix_spawn", __builtin_return_address(0))) return EAGAIN;
  return NEXT(posix_spawn)(process, path, actions, attributes, arguments, environment);
}

int posix_spawnp(pid_t* process, const char* file, const posix_spawn_file_actions_t* actions,
                 const posix_spawnattr_t* attributes, char* const arguments[], char* const environment[]) {
  if (refuses("posix_spawn", __builtin_return_address(0))) return EAGAIN;
  return NEXT(posix_spawnp)(process, file, actions, attributes, arguments, environment);
}
