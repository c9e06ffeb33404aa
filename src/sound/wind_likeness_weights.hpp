#pragma once
// Made by tools/fit_blowing.py from what `wisp_verify_wind --features` prints. Do not edit.

namespace wisp::wind {

constexpr int kLikenessUnits = 8, kLikenessFeatures = 9;
/// Of low, high, voicing, tone, peaked, voice, newest, flutter, clipped; a row for each unit.
constexpr float kLikenessFirst[kLikenessUnits][kLikenessFeatures] = {
    {0.155646F, 0.041306F, -6.320139F, 7.140716F, 0.070041F, -0.514210F, -0.012632F, 0.239234F, 1.231572F},
    {-0.230589F, -0.109820F, 8.219130F, 3.053574F, -0.035028F, 0.040370F, 0.008316F, 0.201656F, 4.353030F},
    {0.242787F, 0.130099F, -1.780002F, 3.867236F, 0.000755F, -0.238931F, 0.030630F, -0.397842F, -0.800943F},
    {-0.343512F, -0.235519F, -0.462747F, -4.396488F, 0.166927F, -0.290699F, 0.026218F, -0.144684F, -17.663253F},
    {0.070284F, -0.104022F, 0.697751F, -6.549441F, -0.276059F, 0.161940F, 0.032714F, -0.354953F, 6.699384F},
    {0.010796F, 0.024148F, 3.859170F, 1.021441F, 0.209158F, -0.472175F, -0.011836F, -0.731599F, 3.539026F},
    {-0.001957F, -0.104301F, 1.365475F, -8.091445F, -0.257497F, -0.002156F, -0.031420F, -0.169785F, 3.523094F},
    {0.313604F, -0.043817F, 1.313248F, 4.058857F, -0.443736F, 0.282647F, 0.015321F, -0.230887F, 1.662127F},
};
constexpr float kLikenessBias[kLikenessUnits] = {1.747965F, -9.165464F, 5.158878F, -7.745701F,
                                                 2.932740F, -0.727248F, 0.929802F, 1.485359F};
constexpr float kLikenessSecond[kLikenessUnits] = {-2.153623F, -2.256947F, -2.797241F, 4.365442F,
                                                   1.647314F,  -2.236766F, 1.449644F,  -2.237065F};
constexpr float kLikenessOffset = 0.940882F;

}  // namespace wisp::wind
