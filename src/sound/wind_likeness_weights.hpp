#pragma once
// Made by tools/fit_blowing.py from what `wisp_verify_wind --features` prints. Do not edit.

namespace wisp::wind {

constexpr int kLikenessUnits = 5;
/// Of low, high, voicing, tone, peaked; a row for each unit.
constexpr float kLikenessFirst[kLikenessUnits][5] = {
    {0.487801F, -0.159278F, -5.453624F, 7.824901F, -0.559469F},
    {-0.274101F, -0.222147F, -0.714341F, -0.050801F, -0.567844F},
    {0.155284F, -0.125983F, -2.178853F, -7.373199F, -0.424851F},
    {0.167036F, 0.296847F, -5.057342F, 8.268309F, -0.014762F},
    {-0.190512F, -0.078132F, 11.405547F, 5.908255F, -0.575604F},
};
constexpr float kLikenessBias[kLikenessUnits] = {1.725264F, -5.473508F, 4.027220F, 7.698165F, -9.797668F};
constexpr float kLikenessSecond[kLikenessUnits] = {-2.296162F, 3.572025F, 2.210056F, -2.789184F, -2.328787F};
constexpr float kLikenessOffset = 0.547070F;

}  // namespace wisp::wind
