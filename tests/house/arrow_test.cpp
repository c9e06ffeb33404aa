#include "house/arrow.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "paths.hpp"

namespace wisp::house::arrow_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(Arrow, TheTreeKeepsIt) { EXPECT_THAT(arrow_violations(WISP_SOURCE_DIR), IsEmpty()); }

TEST(Arrow, TheLinkedLibrariesKeepIt) { EXPECT_THAT(link_violations(WISP_SOURCE_DIR), IsEmpty()); }

TEST(Arrow, TheTreeHasFilesToJudge) {
  const auto files = project_files(WISP_SOURCE_DIR);
  EXPECT_THAT(files, ::testing::Contains("include/wisp/model/model.hpp"));
  EXPECT_THAT(files, ::testing::Contains("src/model/model.cpp"));
}

TEST(Arrow, AnIncludeOfALayerBelowIsFine) {
  ScratchTree tree;
  tree.add("src/learn/a.cpp", "#include \"wisp/model/arx.hpp\"\n#include <vector>\n#include <Eigen/QR>\n");
  EXPECT_THAT(arrow_violations(tree.root()), IsEmpty());
}

TEST(Arrow, AnIncludeThatRunsBackUpIsFound) {
  ScratchTree tree;
  tree.add("src/run/bank.cpp", "#include <vector>\n#include \"wisp/learn/learn.hpp\"\n");
  EXPECT_THAT(arrow_violations(tree.root()),
              ElementsAre("src/run/bank.cpp:2: includes \"wisp/learn/learn.hpp\": run may not include learn"));
}

TEST(Arrow, AnIncludeThatRunsBackUpFromAPublicHeaderIsFound) {
  ScratchTree tree;
  tree.add("include/wisp/model/arx.hpp", "#  include \"wisp/run/bank.hpp\"\n");
  EXPECT_THAT(arrow_violations(tree.root()), ElementsAre(HasSubstr("model may not include run")));
}

TEST(Arrow, VisionMayNotLookIntoMedia) {
  ScratchTree tree;
  tree.add("src/capture/vision/edges.cpp", "#include \"wisp/capture/media/clip.hpp\"\n");
  EXPECT_THAT(arrow_violations(tree.root()), ElementsAre(HasSubstr("capture/vision may not include capture/media")));
}

TEST(Arrow, AnotherLayersPrivateHeaderIsFound) {
  ScratchTree tree;
  tree.add("src/run/bank.cpp", "#include \"model/payload.hpp\"\n");
  tree.add("src/model/payload.hpp", "");
  EXPECT_THAT(arrow_violations(tree.root()), ElementsAre(HasSubstr("a private header of model")));
}

TEST(Arrow, APrivateHeaderThatALayerSharesIsForTheLayersAboveItOnly) {
  ScratchTree tree;
  tree.add("src/record/loudness.hpp", "").add("src/base/hash.hpp", "");
  tree.add("src/learn/gain.cpp", "#include \"base/hash.hpp\"\n#include \"record/loudness.hpp\"\n");
  tree.add("src/run/bank.cpp", "#include \"base/hash.hpp\"\n#include \"record/loudness.hpp\"\n");
  EXPECT_THAT(arrow_violations(tree.root()),
              ElementsAre("src/run/bank.cpp:2: includes \"record/loudness.hpp\": run may not include record"));
}

TEST(Arrow, AnotherLayersPrivateHeaderIsFoundBehindDots) {
  ScratchTree tree;
  tree.add("src/run/bank.cpp", "#include \"../model/payload.hpp\"\n");
  tree.add("src/model/payload.hpp", "");
  EXPECT_THAT(arrow_violations(tree.root()), ElementsAre(HasSubstr("a private header of model")));
}

TEST(Arrow, APrivateHeaderBesideItsSourceIsFine) {
  ScratchTree tree;
  tree.add("src/run/bank.cpp", "#include \"lanes.hpp\"\n#include \"run/lanes.hpp\"\n");
  tree.add("src/run/lanes.hpp", "");
  EXPECT_THAT(arrow_violations(tree.root()), IsEmpty());
}

TEST(Arrow, APrivateHeaderInAPublicOneIsFound) {
  ScratchTree tree;
  tree.add("include/wisp/run/bank.hpp", "#include \"run/lanes.hpp\"\n");
  tree.add("src/run/lanes.hpp", "");
  EXPECT_THAT(arrow_violations(tree.root()), ElementsAre(HasSubstr("is public and includes the private header")));
}

TEST(Arrow, OutsideLibrariesStayWhereTheyBelong) {
  ScratchTree tree;
  tree.add("src/run/a.cpp", "#include <Eigen/Core>\n");
  tree.add("src/run/b.cpp", "#include \"flatbuffers/flatbuffers.h\"\n");
  tree.add("src/capture/vision/c.cpp", "extern \"C\" {\n#include <libavutil/frame.h>\n}\n");
  tree.add("src/learn/d.cpp", "#include <cairo.h>\n");
  tree.add("src/draw/e.cpp", "#include <cairo.h>\n#include <libavcodec/avcodec.h>\n");
  tree.add("src/draw/f.cpp", "#include <CLI/CLI.hpp>\n");
  tree.add("src/record/g.cpp", "#include <unistd.h>\n");
  EXPECT_THAT(arrow_violations(tree.root()),
              ElementsAre(HasSubstr("src/capture/vision/c.cpp:2: includes <libavutil/frame.h>"),
                          HasSubstr("src/draw/f.cpp:1: includes <CLI/CLI.hpp>"),
                          HasSubstr("src/learn/d.cpp:1: includes <cairo.h>"),
                          HasSubstr("src/record/g.cpp:1: includes <unistd.h>"),
                          HasSubstr("src/run/a.cpp:1: includes <Eigen/Core>"),
                          HasSubstr("src/run/b.cpp:1: includes <flatbuffers/flatbuffers.h>")));
}

TEST(Arrow, OutsideLibrariesStayOutOfPublicHeaders) {
  ScratchTree tree;
  tree.add("include/wisp/learn/learn.hpp", "#include <Eigen/Core>\n");
  EXPECT_THAT(arrow_violations(tree.root()), ElementsAre(HasSubstr("outside libraries stay private")));
}

TEST(Arrow, AnApplicationUsesPublicHeadersOnly) {
  ScratchTree tree;
  tree.add("apps/cli/main.cpp", "#include <CLI/CLI.hpp>\n#include \"wisp/run/bank.hpp\"\n#include \"table.hpp\"\n");
  tree.add("apps/cli/table.hpp", "");
  tree.add("apps/cli/peek.cpp", "#include \"run/lanes.hpp\"\n#include <Eigen/Core>\n");
  EXPECT_THAT(arrow_violations(tree.root()),
              ElementsAre(HasSubstr("apps/cli/peek.cpp:1: includes \"run/lanes.hpp\", a private header"),
                          HasSubstr("apps/cli/peek.cpp:2: includes <Eigen/Core>, which belongs to learn")));
}

TEST(Arrow, AnUmbrellaHeaderGathersPublicHeadersOnly) {
  ScratchTree tree;
  tree.add("include/wisp/play.hpp", "#include \"wisp/model/model.hpp\"\n#include \"wisp/run/bank.hpp\"\n");
  tree.add("include/wisp/learn.hpp", "#include \"learn/outline/rows.hpp\"\n#include <Eigen/Core>\n");
  EXPECT_THAT(
      arrow_violations(tree.root()),
      ElementsAre(HasSubstr("include/wisp/learn.hpp:1: gathers public headers and includes \"learn/outline/rows"),
                  HasSubstr("include/wisp/learn.hpp:2: gathers public headers and includes \"Eigen/Core")));
}

TEST(Arrow, NoLayerIncludesAnUmbrellaHeader) {
  ScratchTree tree;
  tree.add("src/learn/a.cpp", "#include \"wisp/play.hpp\"\n");
  tree.add("apps/cli/main.cpp", "#include \"wisp/play.hpp\"\n");
  EXPECT_THAT(arrow_violations(tree.root()), ElementsAre(HasSubstr("src/learn/a.cpp:1: includes \"wisp/play.hpp\"")));
}

TEST(Arrow, AFolderThatIsNoLayerIsFound) {
  ScratchTree tree;
  tree.add("src/shared/a.cpp", "");
  tree.add("include/wisp/shared/a.hpp", "");
  EXPECT_THAT(arrow_violations(tree.root()), ElementsAre(HasSubstr("include/wisp/shared/a.hpp: belongs to no layer"),
                                                         HasSubstr("src/shared/a.cpp: belongs to no layer")));
}

TEST(Arrow, ALinkThatRunsBackUpIsFound) {
  ScratchTree tree;
  tree.add("src/CMakeLists.txt",
           "wisp_layer(run USES model\n  learn OPTIONS -O2)\nwisp_layer(media FOLDER "
           "capture/media USES vision)\nwisp_layer(cloud)\n");
  EXPECT_THAT(link_violations(tree.root()),
              ElementsAre("src/CMakeLists.txt: run may not use learn",
                          "src/CMakeLists.txt: cloud is no layer of docs/architecture.md"));
}

// Emscripten 3.1.6 compiles these layers for the browser; its C++ library has no algorithms on ranges.
TEST(Arrow, LayersOfTheBrowserUseNoAlgorithmsOnRanges) {
  static const std::regex elsewhere("src/(draw|simulate|matfile|capture/media)/.*");
  std::vector<std::string> found;
  for (const std::string& file : project_files(WISP_SOURCE_DIR)) {
    const bool ours = file.starts_with("src/") || file.starts_with("include/");
    if (!ours || std::regex_match(file, elsewhere)) continue;
    if (read_text(std::filesystem::path(WISP_SOURCE_DIR) / file).find("std::ranges::") != std::string::npos)
      found.push_back(file);
  }
  EXPECT_THAT(found, IsEmpty());
}

}  // namespace
}  // namespace wisp::house::arrow_test
