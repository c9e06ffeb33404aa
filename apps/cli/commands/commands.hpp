#pragma once
// Each function creates one command of the table commands().

#include "command.hpp"

namespace wisp::cli {

Command capture_outline_command();
Command capture_flame_command();
Command capture_brightness_command();
Command capture_wind_command();
Command capture_fall_command();
Command learn_outline_command();
Command learn_flame_command();
Command learn_arx_command();
Command learn_switched_command();
Command learn_flicker_command();
Command learn_chain_command();
Command learn_leaf_command();
Command validate_command();
Command predict_command();
Command compare_command();
Command simulate_candle_command();
Command simulate_leaf_command();
Command run_command();
Command export_command();
Command info_command();
Command report_command();
Command play_command();
Command demo_command();
Command manual_command();

}  // namespace wisp::cli
