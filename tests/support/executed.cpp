// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors

// The functions that Clang's -fsanitize-coverage=func,trace-pc-guard calls, for
// tests/check_executed.py: they fill a file for each program and library, in the folder
// EXECUTED_IN, with a word for each of its functions. The word is 0 until a process executes the
// function, then the offset of an instruction in it. All processes map this file, so the way in
// which they end does not matter. tests/run.sh links this source with every program and library.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <dlfcn.h>
#include <fcntl.h>
#include <string>
#include <sys/mman.h>
#include <unistd.h>

namespace {

std::uint64_t* g_words;
std::uintptr_t g_base;  // where the program or library begins

// The file for a program or library: its path, with ! for /.
std::string file_of(const std::string& name) {
  // The name of a program that the shell found has no folder.
  char* path = realpath(name.find('/') == name.npos ? "/proc/self/exe" : name.c_str(), nullptr);
  std::string file = path ? path : "";
  std::free(path);
  std::replace(file.begin(), file.end(), '/', '!');
  return EXECUTED_IN "/" + file;
}

// Returns null when that is not possible.
std::uint64_t* map_words(const std::string& file, std::size_t count) {
  const std::size_t bytes = count * sizeof(std::uint64_t);
  const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  void* memory = MAP_FAILED;
  if (descriptor >= 0 && ftruncate(descriptor, static_cast<off_t>(bytes)) == 0) {
    memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  }
  close(descriptor);
  return memory == MAP_FAILED ? nullptr : static_cast<std::uint64_t*>(memory);
}

}  // namespace

// Hidden, because each program and library has its own words.
#pragma GCC visibility push(hidden)
extern "C" {

// Clang calls this when a program or library is loaded, and again for each of its objects: with a
// guard for each function.
void __sanitizer_cov_trace_pc_guard_init(std::uint32_t* begin, std::uint32_t* end) {
  Dl_info module{};
  if (g_base || !dladdr(begin, &module)) {
    return;
  }
  g_base = reinterpret_cast<std::uintptr_t>(module.dli_fbase);
  g_words = map_words(file_of(module.dli_fname), static_cast<std::size_t>(end - begin));
  for (std::uint32_t* guard = begin; g_words && guard != end; ++guard) {
    *guard = static_cast<std::uint32_t>(guard - begin) + 1;
  }
}

// Clang calls this at the beginning of each function.
void __sanitizer_cov_trace_pc_guard(std::uint32_t* guard) {
  if (*guard) {
    // The return address is in the function, one byte before it is the call.
    const auto call = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0)) - 1;
    __atomic_store_n(&g_words[*guard - 1], call - g_base, __ATOMIC_RELAXED);
    *guard = 0;
  }
}

}  // extern "C"
#pragma GCC visibility pop
