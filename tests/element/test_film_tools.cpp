// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// How long is waited for a file.
#include <fstream>
#include <stdexcept>
#include <string>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "plugin/tracks/file_pipeline.h"
#include "tests/support/element_harness.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test::film_tools_test {
namespace {

TEST(FilmTools, APipelineThatReadsNothingMoreIsNotAwaitedForEver) {
  init_gstreamer();
  const TemporaryFolder folder;
  const std::string path = folder.path / "file";
  std::ofstream(path) << "some bytes";
  // The second sink waits for ever, and the end of the file is not that of the pipeline.
  const FilePipeline file("filesrc name=source ! fakesink appsrc ! fakesink", path, nullptr,
                          200 * GST_MSECOND);
  EXPECT_THROW(file.play_until(GST_MESSAGE_EOS), std::runtime_error);
}

}  // namespace
}  // namespace spidar::test::film_tools_test
