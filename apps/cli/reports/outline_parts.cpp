#include "reports/outline_parts.hpp"

#include "flags/capture_flags.hpp"
#include "flags/part_flags.hpp"
#include "reports/merged_part.hpp"
#include "wisp/base/file.hpp"
#include "wisp/learn/parts.hpp"

namespace wisp::cli {
namespace {

Result<OutlinePart> captured_part(const Arguments& arguments, Terminal& terminal) {
  const auto part = share_of(arguments);
  if (!part) return part.error();
  const ListShare share{arguments.positionals(), part->index, part->count};
  if (share.count > share.names.size()) {
    return Error{"--part " + arguments.text("part") + " of " + std::to_string(share.names.size()) +
                 (share.names.size() == 1 ? " recording" : " recordings") +
                 ": a part takes whole recordings, expected at most one share for each"};
  }
  const auto recordings = outline_recordings(share.own(), arguments, terminal);
  if (!recordings) return recordings.error();
  return OutlinePart::create(*recordings, share);
}

}  // namespace

std::vector<Flag> outline_part_flags() {
  return part_flags(
      "write a part of a fit instead of a model: the recordings of what is named, captured here and learned from "
      "elsewhere",
      "with --partial: take the K-th of N equal shares of what is named",
      "what is named are parts written with --partial, in any order; the model is the same to the byte as that of all "
      "recordings in the order of their names");
}

Result<void> write_outline_part(const Arguments& arguments, Terminal& terminal) {
  const auto part = arguments.on("merge") ? merged_part<OutlinePart>(arguments) : captured_part(arguments, terminal);
  if (!part) return part.error();
  const std::string& path = arguments.text("partial");
  const auto bytes = part->bytes();
  if (auto ok = write_file(path, bytes); !ok) return ok;
  terminal.add("partial", path);
  terminal.add("bytes", bytes.size());
  terminal.add("parts", part->jobs());
  terminal.say("wrote " + path + ": " + std::to_string(bytes.size()) +
               " bytes; --merge of the same command makes a model of all parts");
  return {};
}

Result<std::vector<Recording>> merged_recordings(const Arguments& arguments) {
  const auto part = merged_part<OutlinePart>(arguments);
  if (!part) return part.error();
  return part->recordings();
}

}  // namespace wisp::cli
