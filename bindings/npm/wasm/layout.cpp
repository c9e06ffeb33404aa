// Checks at compile time that the offsets in src/layout.ts are those of the ABI's structs.

#include <cstddef>

#include "wisp/wisp.h"

#define WISP_SIZE(type, bytes) static_assert(sizeof(type) == (bytes), "src/layout.ts: size of " #type)
#define WISP_FIELD(type, field, at) static_assert(offsetof(type, field) == (at), "src/layout.ts: " #type "." #field)

WISP_SIZE(wisp_model_facts, 128);
WISP_FIELD(wisp_model_facts, inputs, 4);
WISP_FIELD(wisp_model_facts, outputs, 8);
WISP_FIELD(wisp_model_facts, control_points, 12);
WISP_FIELD(wisp_model_facts, rate_hz, 24);
WISP_FIELD(wisp_model_facts, metres_per_unit, 32);
WISP_FIELD(wisp_model_facts, step_nanoseconds, 40);
WISP_FIELD(wisp_model_facts, multiply_adds_per_frame, 48);
WISP_FIELD(wisp_model_facts, operations_per_frame, 56);
WISP_FIELD(wisp_model_facts, blow_out_level, 64);
WISP_FIELD(wisp_model_facts, blow_out_seconds, 72);
WISP_FIELD(wisp_model_facts, dynamics, 80);
WISP_FIELD(wisp_model_facts, view, 84);
WISP_FIELD(wisp_model_facts, half_width, 88);
WISP_FIELD(wisp_model_facts, half_length, 96);
WISP_FIELD(wisp_model_facts, blow_out_haste, 104);
WISP_FIELD(wisp_model_facts, blow_out_recovery_seconds, 112);
WISP_FIELD(wisp_model_facts, blow_out_input, 120);

WISP_SIZE(wisp_channel, 40);
WISP_FIELD(wisp_channel, name, 8);
WISP_FIELD(wisp_channel, unit, 12);
WISP_FIELD(wisp_channel, lowest, 16);
WISP_FIELD(wisp_channel, highest, 24);
WISP_FIELD(wisp_channel, even_odd, 32);

WISP_SIZE(wisp_provenance, 32);
WISP_FIELD(wisp_provenance, sources, 4);
WISP_FIELD(wisp_provenance, options, 8);
WISP_FIELD(wisp_provenance, figures, 12);
WISP_FIELD(wisp_provenance, usable, 16);
WISP_FIELD(wisp_provenance, program, 24);
WISP_FIELD(wisp_provenance, reason, 28);

WISP_SIZE(wisp_note, 16);
WISP_FIELD(wisp_note, name, 8);
WISP_FIELD(wisp_note, value, 12);

WISP_SIZE(wisp_figure, 24);
WISP_FIELD(wisp_figure, name, 8);
WISP_FIELD(wisp_figure, value, 16);

WISP_SIZE(wisp_arx_facts, 20);
WISP_FIELD(wisp_arx_facts, outputs, 4);
WISP_FIELD(wisp_arx_facts, regressors, 8);
WISP_FIELD(wisp_arx_facts, history, 12);
WISP_FIELD(wisp_arx_facts, resamples, 16);

WISP_SIZE(wisp_chain_facts, 24);
WISP_FIELD(wisp_chain_facts, modes, 4);
WISP_FIELD(wisp_chain_facts, segments, 8);
WISP_FIELD(wisp_chain_facts, history, 12);
WISP_FIELD(wisp_chain_facts, gust_order, 16);
WISP_FIELD(wisp_chain_facts, heading_free, 20);

WISP_SIZE(wisp_bank_options, 32);
WISP_FIELD(wisp_bank_options, capacity, 4);
WISP_FIELD(wisp_bank_options, polyline_points, 8);
WISP_FIELD(wisp_bank_options, longest, 12);
WISP_FIELD(wisp_bank_options, seed, 16);

WISP_SIZE(wisp_bank_facts, 48);
WISP_FIELD(wisp_bank_facts, capacity, 4);
WISP_FIELD(wisp_bank_facts, alive, 8);
WISP_FIELD(wisp_bank_facts, slots, 12);
WISP_FIELD(wisp_bank_facts, inputs, 16);
WISP_FIELD(wisp_bank_facts, outputs, 20);
WISP_FIELD(wisp_bank_facts, polyline_points, 24);
WISP_FIELD(wisp_bank_facts, clamped, 32);
WISP_FIELD(wisp_bank_facts, steps, 40);

WISP_SIZE(wisp_flame_state, 56);
WISP_FIELD(wisp_flame_state, lit, 4);
WISP_FIELD(wisp_flame_state, flame_size, 8);
WISP_FIELD(wisp_flame_state, since_lit, 16);
WISP_FIELD(wisp_flame_state, since_out, 24);
WISP_FIELD(wisp_flame_state, events, 12);
WISP_FIELD(wisp_flame_state, light, 32);
WISP_FIELD(wisp_flame_state, intensity, 44);
WISP_FIELD(wisp_flame_state, kelvin, 48);

WISP_SIZE(wisp_chain_place, 48);
WISP_FIELD(wisp_chain_place, segment, 4);
WISP_FIELD(wisp_chain_place, step, 8);
WISP_FIELD(wisp_chain_place, mode, 12);
WISP_FIELD(wisp_chain_place, velocity, 16);
WISP_FIELD(wisp_chain_place, spin, 28);
WISP_FIELD(wisp_chain_place, lies, 40);
WISP_FIELD(wisp_chain_place, landed, 44);

WISP_SIZE(wisp_chain_settings, 12);
WISP_FIELD(wisp_chain_settings, has_ground, 4);
WISP_FIELD(wisp_chain_settings, ground, 8);

WISP_SIZE(wisp_body, 56);
WISP_FIELD(wisp_body, position, 4);
WISP_FIELD(wisp_body, orientation, 16);
WISP_FIELD(wisp_body, velocity, 32);
WISP_FIELD(wisp_body, spin, 44);

WISP_SIZE(wisp_wind_options, 56);
WISP_FIELD(wisp_wind_options, channels, 4);
WISP_FIELD(wisp_wind_options, rate_hz, 8);
WISP_FIELD(wisp_wind_options, frame_rate_hz, 16);
WISP_FIELD(wisp_wind_options, exponent, 24);
WISP_FIELD(wisp_wind_options, smoothing_seconds, 32);
WISP_FIELD(wisp_wind_options, floor_rise_db_per_second, 40);
WISP_FIELD(wisp_wind_options, first_gust_rms, 48);

WISP_SIZE(wisp_wind_frame, 40);
WISP_FIELD(wisp_wind_frame, index, 0);
WISP_FIELD(wisp_wind_frame, rms, 8);
WISP_FIELD(wisp_wind_frame, rms_clean, 12);
WISP_FIELD(wisp_wind_frame, level, 16);
WISP_FIELD(wisp_wind_frame, speed, 20);
WISP_FIELD(wisp_wind_frame, wind, 24);
WISP_FIELD(wisp_wind_frame, confidence, 28);
WISP_FIELD(wisp_wind_frame, background, 32);
WISP_FIELD(wisp_wind_frame, clipped, 36);

WISP_SIZE(wisp_wind_calibration, 20);
WISP_FIELD(wisp_wind_calibration, background_rms, 4);
WISP_FIELD(wisp_wind_calibration, background_level, 8);
WISP_FIELD(wisp_wind_calibration, floor_db, 12);
WISP_FIELD(wisp_wind_calibration, gust_rms, 16);
