// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// How long a file is awaited.
#include <gst/gst.h>

#include "plugin/films/file_pipeline.h"
#include "tests/support/element_harness.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace spidar::test::film_tools_test {
namespace {

class FilmTools : public testing::Test {
 protected:
  FilmTools() {
    init_gstreamer();
    std::ofstream(path) << "some bytes";
  }

  const TemporaryFolder folder;
  const std::string path = folder.path / "file";
  // The second sink waits for ever, and the end of the file is not that of the pipeline.
  const char* const line = "filesrc name=source ! fakesink appsrc ! fakesink";
};

TEST_F(FilmTools, APipelineThatReadsNothingMoreIsNotAwaitedForEver) {
  const FilePipeline file(line, path, nullptr, 200 * GST_MSECOND);
  EXPECT_THROW(file.play_until(GST_MESSAGE_EOS), std::runtime_error);
}

TEST_F(FilmTools, ManyMessagesAreNoSilence) {
  const FilePipeline file(line, path, nullptr, 10 * FilePipeline::kLook);
  GstObject* const pipeline = GST_OBJECT(file.pipeline());
  const auto post = [&file](GstMessage* message) {
    gst_element_post_message(file.pipeline(), message);
  };
  for (int i = 0; i < 20; ++i) {
    post(gst_message_new_element(pipeline, gst_structure_new_empty("other")));
  }
  post(gst_message_new_application(pipeline, gst_structure_new_empty("enough")));
  EXPECT_EQ(file.play_until(GST_MESSAGE_APPLICATION), GST_MESSAGE_APPLICATION);
}

}  // namespace
}  // namespace spidar::test::film_tools_test
