#include "wisp/learn/validate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "learn/arx/made_system.hpp"
#include "wisp/learn/learn.hpp"

namespace wisp::validate_test {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

Model learned() {
  const ArxModel made = made_system();
  const ArxRecipe recipe{.name = "made",
                         .inputs = {"u1", "u2"},
                         .outputs = {"y1", "y2"},
                         .na = made.orders.na,
                         .nb = made.orders.nb,
                         .nk = made.orders.nk};
  auto fit = learn(record_system(made, 1000, 1), recipe);
  EXPECT_TRUE(fit) << fit.error().message;
  return std::move(fit->model);
}

TEST(Validate, ARecordingTooShortForResidualTestsHasTheColumnsOfTheOthers) {
  const Recording whole = record_system(made_system(), 400, 2), brief = record_system(made_system(), 60, 3);
  for (const std::vector<Recording>& recordings : {std::vector{whole, brief}, std::vector{brief, whole}}) {
    const auto report = validate(learned(), recordings);
    ASSERT_TRUE(report) << report.error().message;
    const ReportTable& table = report->sections.front().tables.front();
    EXPECT_THAT(table.rows, SizeIs(4));
    EXPECT_THAT(table.rows, Each(SizeIs(table.columns.size())));
  }
}

TEST(Validate, AChannelInAnotherUnitThanTheModelsIsNamed) {
  Model model = learned();
  Recording recording = record_system(made_system(), 400, 2);
  model.inputs[0].unit = recording.channels[0].unit = "V";
  model.outputs[0].unit = "m";
  EXPECT_THAT(validate(model, recording)->warnings, SizeIs(0));
  recording.channels[2].unit = "cm";
  const auto in_other_unit = HasSubstr("made: 'y1' is in cm, in the model in m: units are not converted");
  EXPECT_THAT(validate(model, recording)->warnings, ElementsAre(in_other_unit));
  const auto compared = compare(std::vector<NamedModel>{{"one", model}}, recording);
  ASSERT_TRUE(compared) << compared.error().message;
  EXPECT_THAT(compared->warnings, ElementsAre(HasSubstr("made: 'y1' is in cm, in one in m")));
}

TEST(Compare, ARecordingWithoutPredictedRowsDoesNotHideABadlyFittedOne) {
  const ArxModel made = made_system();
  std::vector<Recording> recordings(2, record_system(made, 2, 2));  // shorter than the history of 3 rows
  for (unsigned seed = 3; seed < 6; ++seed) recordings.push_back(record_system(made, 400, seed));
  recordings.back().source = "bad";
  for (std::size_t c = 2; c < 4; ++c) {
    for (double& y : recordings.back().channels[c].samples) y = -y;
  }
  const auto report = compare(std::vector<NamedModel>{{"one", learned()}}, recordings);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_THAT(report->warnings, SizeIs(2));
  EXPECT_THAT(report->warnings, Each(HasSubstr("bad is fitted badly")));
}

}  // namespace
}  // namespace wisp::validate_test
