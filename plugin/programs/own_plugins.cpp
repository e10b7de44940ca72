// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/programs/own_plugins.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <gst/gst.h>

#include "plugin/gobject/ref.h"
#include "spidar/folders.h"

namespace spidar {
namespace {

namespace fs = std::filesystem;

/// Returns an empty string when the plugins are in neither folder.
std::string folder_of(const std::vector<std::string>& names) {
  for (const fs::path& folder : {own_file().parent_path(), installed(SPIDAR_PLUGIN_DIR)}) {
    const bool has_all = std::all_of(names.begin(), names.end(), [&](const std::string& name) {
      std::error_code error;
      return fs::exists(folder / ("libgst" + name + ".so"), error);
    });
    if (has_all) return folder.string();
  }
  return {};
}

bool has_all(const std::vector<std::string>& names) {
  return std::all_of(names.begin(), names.end(), [](const std::string& name) {
    const Ref<GstPlugin> plugin(gst_registry_find_plugin(gst_registry_get(), name.c_str()));
    return plugin && std::strcmp(gst_plugin_get_version(plugin.get()), PACKAGE_VERSION) == 0;
  });
}

/// GStreamer ignores GST_PLUGIN_PATH if GST_PLUGIN_PATH_1_0 exists, even if that is empty.
const char* path_variable() {
  return g_getenv("GST_PLUGIN_PATH_1_0") ? "GST_PLUGIN_PATH_1_0" : "GST_PLUGIN_PATH";
}

void search_first(const std::string& folder, const std::vector<std::string>& names) {
  const char* const before = g_getenv(path_variable());
  const std::string path = before && *before ? folder + ":" + before : folder;
  g_setenv(path_variable(), path.c_str(), TRUE);
  GstRegistry* const registry = gst_registry_get();
  for (const std::string& name : names) {  // otherwise one that was found first stays
    const Ref<GstPlugin> older(gst_registry_find_plugin(registry, name.c_str()));
    if (older) gst_registry_remove_plugin(registry, older.get());
  }
  gst_registry_scan_path(registry, folder.c_str());
}

}  // namespace

std::string find_own_plugins(const std::vector<std::string>& names) {
  if (has_all(names)) return {};
  const std::string folder = folder_of(names);
  if (!folder.empty()) search_first(folder, names);
  if (has_all(names)) return {};
  std::string files;
  for (const std::string& name : names) {
    files += (files.empty() ? "libgst" : " and libgst") + name + ".so";
  }
  return "GStreamer does not find this version of the plugins of gst-spidar, " + files +
         "; name their folder in " + path_variable();
}

}  // namespace spidar
