// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/glfw/private_glfw.h"

#include <cstring>
#include <dlfcn.h>
#include <elf.h>
#include <fstream>
#include <iterator>
#include <link.h>
#include <stdexcept>
#include <sys/mman.h>
#include <unistd.h>

namespace spidar {
namespace {

constexpr const char* kLibrary = "libglfw.so.3";

std::runtime_error linker_error() {
  const char* const why = dlerror();
  return std::runtime_error(why ? why : "the dynamic linker does not say why");
}

/// The file that the dynamic linker finds under this name.
std::string path_of(const char* name) {
  void* const library = dlopen(name, RTLD_LAZY | RTLD_LOCAL);
  if (!library) throw linker_error();
  link_map* map = nullptr;
  const bool found = dlinfo(library, RTLD_DI_LINKMAP, &map) == 0;
  std::string path = found ? map->l_name : "";
  dlclose(library);
  if (!found) throw linker_error();
  return path;
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Reads from a place in the file. Throws std::out_of_range.
template <typename Part>
Part part_of(const std::string& file, size_t at) {
  Part part;
  if (at > file.size() || file.size() - at < sizeof part) throw std::out_of_range("truncated");
  std::memcpy(&part, file.data() + at, sizeof part);
  return part;
}

/// Without its name, the dynamic linker does not give the copy to others that ask for GLFW. With
/// DT_SYMBOLIC, calls inside the copy stay there, even if the application is linked with GLFW. The
/// entry of the one is turned into the other.
void make_private(std::string& library) {
  const auto header = part_of<ElfW(Ehdr)>(library, 0);
  for (size_t i = 0; i < header.e_phnum; ++i) {
    const auto segment = part_of<ElfW(Phdr)>(library, header.e_phoff + i * header.e_phentsize);
    if (segment.p_type != PT_DYNAMIC) continue;
    for (size_t at = 0; at + sizeof(ElfW(Dyn)) <= segment.p_filesz; at += sizeof(ElfW(Dyn))) {
      auto entry = part_of<ElfW(Dyn)>(library, segment.p_offset + at);
      if (entry.d_tag != DT_SONAME) continue;
      entry.d_tag = DT_SYMBOLIC;
      std::memcpy(library.data() + segment.p_offset + at, &entry, sizeof entry);
      return;
    }
  }
  throw std::runtime_error("no shared library with a name");
}

void* load_from_memory(const std::string& library) {
  const int file = memfd_create(kLibrary, MFD_CLOEXEC);
  if (file < 0) throw std::runtime_error(std::string("memory: ") + std::strerror(errno));
  const bool written =
      write(file, library.data(), library.size()) == static_cast<ssize_t>(library.size());
  // The dynamic linker does not load a name twice, and others may use /proc/self/fd in this way.
  const std::string path =
      "/proc/self/task/" + std::to_string(gettid()) + "/fd/" + std::to_string(file);
  void* const handle = written ? dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL) : nullptr;
  close(file);
  if (!handle) throw written ? linker_error() : std::runtime_error("no memory");
  return handle;
}

}  // namespace

std::string load_glfw(const char* const* names, void** functions, size_t count) {
  if (functions[0] != nullptr) return {};
  try {
    std::string library = bytes_of(path_of(kLibrary));
    make_private(library);
    void* const handle = load_from_memory(library);
    for (size_t i = count; i-- > 0;) {
      functions[i] = dlsym(handle, names[i]);
      if (!functions[i]) throw linker_error();
    }
    return {};
  } catch (const std::exception& error) {
    return std::string(kLibrary) + ": " + error.what();
  }
}

}  // namespace spidar
