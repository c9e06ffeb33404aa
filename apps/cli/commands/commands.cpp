#include "commands/commands.hpp"

#include <cstdio>

#include "terminal.hpp"

namespace wisp::cli {

const std::vector<Command>& commands() {
  static const std::vector<Command> all = {
      capture_outline_command(),
      capture_flame_command(),
      capture_brightness_command(),
      capture_fall_command(),
      learn_outline_command(),
      learn_flame_command(),
      learn_arx_command(),
      learn_switched_command(),
      learn_flicker_command(),
      learn_chain_command(),
      learn_leaf_command(),
      validate_command(),
      predict_command(),
      compare_command(),
      simulate_candle_command(),
      simulate_leaf_command(),
      run_command(),
      export_command(),
      info_command(),
      report_command(),
      play_command(),
      demo_command(),
      manual_command(),
  };
  return all;
}

Command manual_command() {
  return {"manual",
          "Prints this page: all commands and flags, as Markdown.",
          {},
          {},
          {},
          [](const Arguments&, Terminal& terminal) -> Result<void> {
            if (terminal.json()) {
              terminal.add("manual", manual());
            } else {
              std::fputs(manual().c_str(), stdout);
            }
            return {};
          }};
}

}  // namespace wisp::cli
