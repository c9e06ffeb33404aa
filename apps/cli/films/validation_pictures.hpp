#pragma once
// Draws all pictures of an outline's validation.

#include <optional>
#include <string>

#include "films/outline_film.hpp"
#include "terminal.hpp"
#include "wisp/base/report.hpp"
#include "wisp/learn/validate.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// A recording and the clip that it was captured from, if any.
struct ValidationSubject {
  Recording recording{};
  ClipFrames clip{};
  std::optional<Report> captured{};  ///< report of capture(), if the clip was captured by this command
};

/// Paths of the pictures to write; empty: not written.
struct ValidationPictures {
  std::string overlay;
  std::string film_strip;
  std::string figures;  ///< folder
};

/// Draws the pictures that have a path. Errors: a clip cannot be read, a file cannot be written.
Result<void> draw_validation(const ValidatedOutline& found, const Model& model, const ValidationSubject& subject,
                             const ValidationPictures& pictures, Terminal& terminal);

}  // namespace wisp::cli
