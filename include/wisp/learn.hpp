#pragma once
// All headers for making models from recordings: capture, learning, validation, their options and reports. To play
// models, include wisp/play.hpp.

#include "wisp/capture/capture.hpp"
#include "wisp/describe/json.hpp"
#include "wisp/describe/text.hpp"
#include "wisp/learn/learn.hpp"
#include "wisp/learn/model_report.hpp"
#include "wisp/learn/validate.hpp"
#include "wisp/model/file.hpp"
#include "wisp/record/csv.hpp"
