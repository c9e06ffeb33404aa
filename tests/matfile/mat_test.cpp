#include "wisp/record/mat.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <matio.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

namespace wisp {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// A MATLAB file for one test, removed afterwards.
class ScratchMat {
 public:
  ScratchMat(const std::string& name, mat_ft level)
      : path_(std::filesystem::temp_directory_path() / ("wisp_mat_" + name + ".mat")) {
    std::filesystem::remove(path_);
    file_ = Mat_CreateVer(path_.c_str(), nullptr, level);
  }
  ~ScratchMat() {
    close();
    std::filesystem::remove(path_);
  }

  ScratchMat& matrix(const char* name, std::size_t rows, std::size_t columns, std::vector<double> numbers,
                     matio_compression compression = MAT_COMPRESSION_NONE) {
    std::size_t dims[2] = {rows, columns};
    matvar_t* variable = Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims, numbers.data(), 0);
    Mat_VarWrite(file_, variable, compression);
    Mat_VarFree(variable);
    return *this;
  }
  ScratchMat& integers(const char* name, std::vector<std::int16_t> numbers) {
    std::size_t dims[2] = {numbers.size(), 1};
    matvar_t* variable = Mat_VarCreate(name, MAT_C_INT16, MAT_T_INT16, 2, dims, numbers.data(), 0);
    Mat_VarWrite(file_, variable, MAT_COMPRESSION_NONE);
    Mat_VarFree(variable);
    return *this;
  }
  ScratchMat& structure(const char* name, const char* field, std::vector<double> numbers) {
    std::size_t one[2] = {1, 1};
    std::size_t dims[2] = {numbers.size(), 1};
    const char* fields[] = {field};
    matvar_t* variable = Mat_VarCreateStruct(name, 2, one, fields, 1);
    Mat_VarSetStructFieldByName(variable, field, 0,
                                Mat_VarCreate(nullptr, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims, numbers.data(), 0));
    Mat_VarWrite(file_, variable, MAT_COMPRESSION_NONE);
    Mat_VarFree(variable);
    return *this;
  }
  ScratchMat& text(const char* name, const char* value) {
    std::size_t dims[2] = {1, std::string(value).size()};
    matvar_t* variable = Mat_VarCreate(name, MAT_C_CHAR, MAT_T_UINT8, 2, dims, const_cast<char*>(value), 0);
    Mat_VarWrite(file_, variable, MAT_COMPRESSION_NONE);
    Mat_VarFree(variable);
    return *this;
  }
  const std::filesystem::path& close() {
    if (file_ != nullptr) Mat_Close(file_);
    file_ = nullptr;
    return path_;
  }

 private:
  std::filesystem::path path_;
  mat_t* file_ = nullptr;
};

class MatLevels : public ::testing::TestWithParam<mat_ft> {
 protected:
  ScratchMat make(const std::string& name) const { return ScratchMat(name + std::to_string(GetParam()), GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(Mat, MatLevels, ::testing::Values(MAT_FT_MAT5, MAT_FT_MAT73),
                         [](const auto& level) { return level.param == MAT_FT_MAT5 ? "5" : "73"; });

std::string error_of(const std::filesystem::path& path, const MatOptions& options) {
  const auto recording = read_mat(path, options);
  EXPECT_FALSE(recording);
  return recording ? "" : recording.error().message;
}

TEST_P(MatLevels, ReadsVectorsAndColumnsByName) {
  const double missing = std::numeric_limits<double>::quiet_NaN();
  auto file = make("vectors");
  file.matrix("u", 3, 2, {1, 2, 3, 4, 5, 6}, MAT_COMPRESSION_ZLIB).matrix("y", 1, 3, {0.1, missing, -1e300});
  file.integers("k", {-7, 0, 32767}).matrix("Ts", 1, 1, {0.08});
  const auto recording = read_mat(file.close(), {.inputs = {"u", "k"}, .outputs = {"y"}});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_NEAR(recording->rate_hz, 12.5, 1e-12);
  ASSERT_EQ(recording->channels.size(), 4u);
  EXPECT_EQ(recording->channels[0].name, "u1");
  EXPECT_EQ(recording->channels[1].name, "u2");
  EXPECT_EQ(recording->channels[1].role, Role::kInput);
  EXPECT_THAT(recording->channels[1].samples, ElementsAre(4, 5, 6));
  EXPECT_THAT(recording->channels[2].samples, ElementsAre(-7, 0, 32767));
  EXPECT_EQ(recording->channels[3].role, Role::kOutput);
  EXPECT_EQ(recording->channels[3].samples[0], 0.1);
  EXPECT_TRUE(std::isnan(recording->channels[3].samples[1]));
  EXPECT_EQ(recording->channels[3].samples[2], -1e300);
}

TEST_P(MatLevels, ReadsFieldsAndSingleColumns) {
  auto file = make("fields");
  file.structure("data", "y", {1, 2, 3}).matrix("u", 3, 2, {1, 2, 3, 4, 5, 6});
  const auto recording = read_mat(file.close(), {.rate_hz = 10, .inputs = {"u(:,2)"}, .outputs = {"data.y"}});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->channels[0].name, "u(:,2)");
  EXPECT_THAT(recording->channels[0].samples, ElementsAre(4, 5, 6));
  EXPECT_THAT(recording->channels[1].samples, ElementsAre(1, 2, 3));
}

TEST_P(MatLevels, ListsWhatItCouldRead) {
  auto file = make("list");
  file.structure("data", "y", {1, 2, 3}).matrix("u", 3, 2, {1, 2, 3, 4, 5, 6}).text("note", "hello");
  const auto names = list_mat(file.close());
  ASSERT_TRUE(names);
  EXPECT_THAT(*names, ::testing::UnorderedElementsAre("data.y (3 × 1)", "u (3 × 2)"));
}

TEST_P(MatLevels, SaysWhatIsWrong) {
  auto file = make("wrong");
  file.matrix("u", 3, 1, {1, 2, 3}).matrix("y", 4, 1, {1, 2, 3, 4}).text("note", "hello");
  file.matrix("far", 3, 1, {1, std::numeric_limits<double>::infinity(), 3});
  const auto& path = file.close();
  EXPECT_THAT(error_of(path, {.rate_hz = 1, .inputs = {"u"}, .outputs = {"z"}}),
              AllOf(HasSubstr("wisp_mat_wrong"), HasSubstr("variable z"), HasSubstr("y (4 × 1)")));
  EXPECT_THAT(error_of(path, {.rate_hz = 1, .inputs = {"u"}, .outputs = {"y"}}),
              AllOf(HasSubstr("4 samples"), HasSubstr("3")));
  EXPECT_THAT(error_of(path, {.rate_hz = 1, .outputs = {"note"}}), HasSubstr("numeric"));
  EXPECT_THAT(error_of(path, {.rate_hz = 1, .outputs = {"far"}}), HasSubstr("sample 2 is infinite"));
  EXPECT_THAT(error_of(path, {.rate_hz = 1, .outputs = {"u(:,2)"}}), HasSubstr("1 columns"));
  EXPECT_THAT(error_of(path, {.rate_hz = 1, .outputs = {"u("}}), HasSubstr("variable u("));
  EXPECT_THAT(error_of(path, {.outputs = {"u"}}), HasSubstr("no rate"));
  EXPECT_THAT(error_of(path, {.rate_hz = 1}), HasSubstr("name the variables"));
}

TEST_P(MatLevels, EveryCutIsAnErrorOrWhole) {
  auto file = make("cut");
  std::vector<double> numbers(200, 1.5);
  file.matrix("u", 200, 1, numbers).matrix("y", 200, 1, numbers, MAT_COMPRESSION_ZLIB);
  std::ifstream stream(file.close(), std::ios::binary);
  const std::string whole(std::istreambuf_iterator<char>(stream), {});
  const auto path =
      std::filesystem::temp_directory_path() / ("wisp_mat_cut_short" + std::to_string(GetParam()) + ".mat");
  const std::size_t step = GetParam() == MAT_FT_MAT5 ? 7 : 97;
  for (std::size_t length = 0; length < whole.size(); length += step) {
    std::ofstream(path, std::ios::binary).write(whole.data(), static_cast<std::streamsize>(length));
    const auto recording = read_mat(path, {.rate_hz = 1, .inputs = {"u"}, .outputs = {"y"}});
    if (recording) {
      EXPECT_EQ(recording->rows(), 200u);
      EXPECT_EQ(recording->channels[1].samples, numbers) << length;
    }
  }
  std::filesystem::remove(path);
}

TEST(Mat, RefusesWhatIsNotAMatlabFile) {
  const auto path = std::filesystem::temp_directory_path() / "wisp_mat_not.mat";
  std::ofstream(path)
      << "u1,y1\n1,2\n3,4\n and so on, long enough to be taken for a header of 128 bytes, which a table "
         "of numbers in text form might well be taken for";
  EXPECT_THAT(error_of(path, {.rate_hz = 1, .outputs = {"y"}}), HasSubstr("not a MATLAB file"));
  EXPECT_FALSE(list_mat(path));
  std::filesystem::remove(path);
  EXPECT_THAT(error_of(path, {.rate_hz = 1, .outputs = {"y"}}), HasSubstr("no such file"));
}

}  // namespace
}  // namespace wisp
