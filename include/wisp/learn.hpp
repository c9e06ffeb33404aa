#pragma once
// Everything that turns recordings into models: capture, learn, validate, and what they take and answer with.
// wisp/play.hpp is for playing them.

#include "wisp/capture/capture.hpp"
#include "wisp/describe/json.hpp"
#include "wisp/describe/text.hpp"
#include "wisp/learn/learn.hpp"
#include "wisp/learn/model_report.hpp"
#include "wisp/learn/validate.hpp"
#include "wisp/model/file.hpp"
#include "wisp/record/csv.hpp"
