#pragma once
// Made by tools/fit_blowing.py from what `wisp_verify_wind --features` prints. Do not edit.

namespace wisp::wind {

constexpr int kLikenessUnits = 6;
/// Of low, high, voicing, tone, peaked; a row for each unit.
constexpr float kLikenessFirst[kLikenessUnits][5] = {
    {0.000000F, 0.000000F, -0.000000F, 0.000169F, -0.000000F},
    {0.526704F, -0.029883F, -2.434559F, 12.972559F, -0.527831F},
    {-0.010480F, 0.004234F, -3.141943F, 1.395416F, -0.960524F},
    {-0.070966F, -0.114691F, -0.474659F, -7.059048F, 0.058312F},
    {0.037807F, 0.254106F, -8.796834F, 3.927049F, 0.130996F},
    {-0.323649F, -0.136919F, 11.410008F, 3.794534F, 0.001552F},
};
constexpr float kLikenessBias[kLikenessUnits] = {-0.517713F, 0.781091F, 3.032093F, 1.226983F, 9.834062F, -11.551318F};
constexpr float kLikenessSecond[kLikenessUnits] = {0.000174F, -1.827700F, 0.423501F, 2.130193F, -1.955909F, -2.127848F};
constexpr float kLikenessOffset = 0.979023F;

}  // namespace wisp::wind
