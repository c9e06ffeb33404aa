#include "wisp/record/mat.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <matio.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

namespace wisp::mat_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// A MATLAB file for one test, removed afterwards.
class ScratchMat {
 public:
  explicit ScratchMat(const std::string& name, mat_ft level = MAT_FT_MAT5)
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
  // `count` structures of the same fields, a column of numbers each.
  ScratchMat& structures(const char* name, std::size_t count,
                         std::vector<std::pair<const char*, std::vector<double>>> columns) {
    std::size_t shape[2] = {1, count};
    std::vector<const char*> fields;
    for (const auto& column : columns) fields.push_back(column.first);
    matvar_t* variable = Mat_VarCreateStruct(name, 2, shape, fields.data(), static_cast<unsigned>(fields.size()));
    for (std::size_t at = 0; at < count; ++at) {
      for (auto& [field, numbers] : columns) {
        std::size_t dims[2] = {numbers.size(), 1};
        Mat_VarSetStructFieldByName(variable, field, at,
                                    Mat_VarCreate(nullptr, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims, numbers.data(), 0));
      }
    }
    Mat_VarWrite(file_, variable, MAT_COMPRESSION_NONE);
    Mat_VarFree(variable);
    return *this;
  }
  ScratchMat& structure(const char* name, const char* field, std::vector<double> numbers) {
    return structures(name, 1, {{field, std::move(numbers)}});
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

std::string error_of(const std::filesystem::path& path, const MatOptions& options) {
  const auto recording = read_mat(path, options);
  EXPECT_FALSE(recording);
  return recording ? "" : recording.error().message;
}

TEST(Mat, ReadsVectorsAndColumnsByName) {
  const double missing = std::numeric_limits<double>::quiet_NaN();
  ScratchMat file("vectors");
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

TEST(Mat, ReadsFieldsAndSingleColumns) {
  ScratchMat file("fields");
  file.structure("data", "y", {1, 2, 3}).matrix("u", 3, 2, {1, 2, 3, 4, 5, 6});
  const auto recording = read_mat(file.close(), {.rate_hz = 10, .inputs = {"u(:,2)"}, .outputs = {"data.y"}});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->channels[0].name, "u(:,2)");
  EXPECT_THAT(recording->channels[0].samples, ElementsAre(4, 5, 6));
  EXPECT_THAT(recording->channels[1].samples, ElementsAre(1, 2, 3));
}

TEST(Mat, AColumnHasTheNameThatItGetsUnlessAVariableHasIt) {
  ScratchMat file("names");
  file.matrix("u", 3, 2, {1, 2, 3, 4, 5, 6}).matrix("u1", 3, 1, {7, 8, 9});
  const auto path = file.close();
  const auto recording = read_mat(path, {.rate_hz = 10, .inputs = {"u1"}, .outputs = {"u2"}});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_THAT(recording->channels[0].samples, ElementsAre(7, 8, 9));
  EXPECT_EQ(recording->channels[1].name, "u2");
  EXPECT_THAT(recording->channels[1].samples, ElementsAre(4, 5, 6));
  EXPECT_THAT(error_of(path, {.rate_hz = 10, .inputs = {"u3"}}), HasSubstr("u(:,3): the variable has 2 columns"));
  EXPECT_THAT(error_of(path, {.rate_hz = 10, .inputs = {"w2"}}), HasSubstr("w2: there is no such variable"));
}

TEST(Mat, ListsWhatItCouldRead) {
  ScratchMat file("list");
  file.structure("data", "y", {1, 2, 3}).matrix("u", 3, 2, {1, 2, 3, 4, 5, 6}).text("note", "hello");
  const auto names = list_mat(file.close());
  ASSERT_TRUE(names);
  EXPECT_THAT(*names, ::testing::UnorderedElementsAre("data.y (3 × 1)", "u (3 × 2)"));
}

TEST(Mat, FieldsAfterOthersAreFound) {
  ScratchMat file("several");
  file.structures("data", 1, {{"u", {7, 8, 9, 10}}, {"y", {1, 2, 3}}, {"z", {4, 5}}});
  const auto& path = file.close();
  const auto names = list_mat(path);
  ASSERT_TRUE(names);
  EXPECT_THAT(*names, ElementsAre("data.u (4 × 1)", "data.y (3 × 1)", "data.z (2 × 1)"));
  const auto recording = read_mat(path, {.rate_hz = 1, .outputs = {"data.z"}});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_THAT(recording->channels[0].samples, ElementsAre(4, 5));
}

TEST(Mat, AnArrayOfStructuresHasNoFieldOfOneName) {
  ScratchMat file("array");
  file.structures("runs", 2, {{"y", {1, 2, 3}}}).matrix("u", 3, 1, {1, 2, 3});
  const auto& path = file.close();
  const auto names = list_mat(path);
  ASSERT_TRUE(names);
  EXPECT_THAT(*names, ElementsAre("u (3 × 1)"));
  EXPECT_THAT(error_of(path, {.rate_hz = 1, .outputs = {"runs.y"}}), HasSubstr("runs.y"));
}

TEST(Mat, SaysWhatIsWrong) {
  ScratchMat file("wrong");
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

TEST(Mat, AVectorOfTimeGivesTheRate) {
  ScratchMat file("timed");
  file.matrix("t", 4, 1, {0, 0.08, 0.16, 0.24}).matrix("u", 4, 1, {1, 2, 3, 4}).matrix("time", 4, 1, {0, 1, 3, 4});
  EXPECT_NEAR(read_mat(file.close(), {.outputs = {"u"}})->rate_hz, 12.5, 1e-9);
  std::vector<double> times;
  for (int k = 0; k < 2000; ++k) times.push_back(static_cast<double>(static_cast<float>(3000 + 0.01 * k)));
  ScratchMat single("single");
  single.matrix("t", times.size(), 1, times).matrix("u", times.size(), 1, times);
  EXPECT_NEAR(read_mat(single.close(), {.outputs = {"u"}})->rate_hz, 100, 1e-9);
  ScratchMat uneven("untimed");
  uneven.matrix("time", 4, 1, {0, 1, 3, 4}).matrix("u", 4, 1, {1, 2, 3, 4});
  EXPECT_THAT(error_of(uneven.close(), {.outputs = {"u"}}),
              AllOf(HasSubstr("variable time"), HasSubstr("3 after 1"), HasSubstr("--rate")));
}

TEST(Mat, EveryCutIsAnErrorOrWhole) {
  ScratchMat file("cut");
  std::vector<double> numbers(200, 1.5);
  file.matrix("u", 200, 1, numbers).matrix("y", 200, 1, numbers, MAT_COMPRESSION_ZLIB);
  std::ifstream stream(file.close(), std::ios::binary);
  const std::string whole(std::istreambuf_iterator<char>(stream), {});
  const auto path = std::filesystem::temp_directory_path() / "wisp_mat_cut_short.mat";
  for (std::size_t length = 0; length < whole.size(); length += 7) {
    std::ofstream(path, std::ios::binary).write(whole.data(), static_cast<std::streamsize>(length));
    const auto recording = read_mat(path, {.rate_hz = 1, .inputs = {"u"}, .outputs = {"y"}});
    if (recording) {
      EXPECT_EQ(recording->rows(), 200u);
      EXPECT_EQ(recording->channels[1].samples, numbers) << length;
    }
  }
  std::filesystem::remove(path);
}

// A structure within a file of level 5 as damaged files have them, byte by byte.
class HandMade {
 public:
  explicit HandMade(const char* name)
      : path_(std::filesystem::temp_directory_path() / ("wisp_mat_" + std::string(name) + ".mat")) {
    bytes_.assign(124, ' ');
    bytes_ += std::string("\x00\x01IM", 4);
  }
  ~HandMade() { std::filesystem::remove(path_); }

  static std::string part(std::uint32_t kind, const std::string& data, std::uint32_t claimed) {
    std::string bytes(8, '\0');
    std::memcpy(&bytes[0], &kind, 4);
    std::memcpy(&bytes[4], &claimed, 4);
    return bytes + data + std::string((8 - data.size() % 8) % 8, '\0');
  }
  static std::string part(std::uint32_t kind, const std::string& data) {
    return part(kind, data, static_cast<std::uint32_t>(data.size()));
  }
  static std::string words(std::vector<std::uint32_t> values) {
    return {reinterpret_cast<const char*>(values.data()), 4 * values.size()};
  }
  static std::string array(std::uint32_t type, std::vector<std::uint32_t> dims, const std::string& name,
                           const std::string& rest) {
    return part(14, part(6, words({type, 0})) + part(5, words(std::move(dims))) + part(1, name) + rest);
  }

  const std::filesystem::path& with(const std::string& more) {
    std::ofstream(path_, std::ios::binary) << bytes_ << more;
    return path_;
  }

 private:
  std::filesystem::path path_;
  std::string bytes_;
};

constexpr std::uint32_t kDouble = 6, kStruct = 2;

TEST(HandMadeMat, IsReadLikeAnyOther) {
  HandMade file("made");
  const double numbers[] = {1, 2, 3};
  const std::string three(reinterpret_cast<const char*>(numbers), sizeof numbers);
  const std::string y = HandMade::array(kDouble, {3, 1}, "", HandMade::part(9, three));
  const std::string field =
      HandMade::part(5, HandMade::words({8})) + HandMade::part(1, std::string("y\0\0\0\0\0\0\0", 8));
  const auto& path = file.with(HandMade::array(kStruct, {1, 1}, "data", field + y));
  const auto recording = read_mat(path, {.rate_hz = 1, .outputs = {"data.y"}});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_THAT(recording->channels[0].samples, ElementsAre(1, 2, 3));
}

TEST(HandMadeMat, AStructureWithoutFieldsHasNone) {
  HandMade file("no_fields");
  for (const std::string& fields :
       {std::string(), HandMade::part(5, HandMade::words({0})), HandMade::part(5, HandMade::words({32})),
        HandMade::part(5, HandMade::words({32})) + HandMade::part(1, ""),
        HandMade::part(5, HandMade::words({0x7fffffff})) + HandMade::part(1, "", 0x7fffffff)}) {
    const auto& path = file.with(HandMade::array(kStruct, {1, 1}, "data", fields));
    EXPECT_THAT(error_of(path, {.rate_hz = 1, .outputs = {"data.u"}}), HasSubstr("variable data.u"));
    EXPECT_THAT(error_of(path, {.rate_hz = 1, .outputs = {"nope"}}), HasSubstr("the file has: nothing numeric"));
  }
}

TEST(HandMadeMat, ASizeThatIsOnlyClaimedTakesNoMemory) {
  HandMade file("claims");
  for (const auto& dims :
       {std::vector<std::uint32_t>{336860180, 54036}, {0x7fffffff, 1}, {100000000, 1}, {1u << 20, 1u << 20}}) {
    const auto& path =
        file.with(HandMade::array(kDouble, dims, "u", HandMade::part(9, std::string(64, 'x'), 0x7ffffff8)));
    EXPECT_THAT(error_of(path, {.rate_hz = 1, .outputs = {"u"}}),
                testing::AnyOf(HasSubstr("damaged"), HasSubstr("would be unpacked")));
    EXPECT_TRUE(list_mat(path));
  }
}

TEST(HandMadeMat, EveryByteChangedIsAnErrorOrARecording) {
  HandMade file("bytes");
  const std::string eight(64, '\x3f');
  const std::string field =
      HandMade::part(5, HandMade::words({8})) + HandMade::part(1, std::string("y\0\0\0\0\0\0\0", 8));
  const std::string y = HandMade::array(kDouble, {8, 1}, "", HandMade::part(9, eight));
  const std::string whole = HandMade::array(kDouble, {8, 1}, "u", HandMade::part(9, eight)) +
                            HandMade::array(kStruct, {1, 1}, "data", field + y);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (char harm : {'\0', '\1', '\x7f', '\xff'}) {
      std::string bytes = whole;
      bytes[at] = harm;
      const auto& path = file.with(bytes);
      (void)list_mat(path);
      (void)read_mat(path, {.rate_hz = 1, .inputs = {"u"}, .outputs = {"data.y"}});
    }
  }
}

// Ten million zeros pack to some 80 kB, which would unpack to 80 MB.
TEST(Mat, APackedFileUnpacksTo64TimesItsLengthUnlessMoreIsAllowed) {
  ScratchMat file("bomb");
  file.matrix("u", 10'000'000, 1, std::vector<double>(10'000'000), MAT_COMPRESSION_ZLIB);
  const auto& path = file.close();
  ASSERT_LT(std::filesystem::file_size(path), 100'000u);
  EXPECT_THAT(error_of(path, {.rate_hz = 1, .outputs = {"u"}}),
              AllOf(HasSubstr("more than 64 MB of numbers would be unpacked"), HasSubstr("--unpacked GB")));
  EXPECT_TRUE(read_mat(path, {.rate_hz = 1, .max_bytes = 100'000'000, .outputs = {"u"}}));
}

TEST(Mat, VariablesOfAFileShareItsBudget) {
  ScratchMat file("shared");
  const std::vector<double> zeros(5'000'000);
  file.matrix("u", zeros.size(), 1, zeros, MAT_COMPRESSION_ZLIB)
      .matrix("y", zeros.size(), 1, zeros, MAT_COMPRESSION_ZLIB);
  EXPECT_THAT(error_of(file.close(), {.rate_hz = 1, .inputs = {"u"}, .outputs = {"y"}}),
              AllOf(HasSubstr("variable y"), HasSubstr("would be unpacked")));
}

TEST(Mat, OfAMatrixOnlyTheColumnsThatAreReadCount) {
  ScratchMat file("columns");
  file.matrix("u", 1'000'000, 5, std::vector<double>(5'000'000), MAT_COMPRESSION_ZLIB);
  const auto recording = read_mat(file.close(), {.rate_hz = 1, .inputs = {"u(:,1)", "u2"}, .outputs = {"u3"}});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->channels.size(), 3u);
}

TEST(Mat, SaysHowToSaveAFileOfLevel73) {
  ScratchMat file("level73", MAT_FT_MAT73);
  file.matrix("u", 3, 1, {1, 2, 3});
  EXPECT_THAT(error_of(file.close(), {.rate_hz = 1, .outputs = {"u"}}),
              AllOf(HasSubstr("level 7.3, which is HDF5"), HasSubstr("-v7")));
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
  EXPECT_THAT(error_of(std::string(5000, 'x'), {.rate_hz = 1, .outputs = {"y"}}), HasSubstr("no such file"));
}

}  // namespace
}  // namespace wisp::mat_test
