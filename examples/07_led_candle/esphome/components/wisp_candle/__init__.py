"""ESPHome: the effect `wisp_candle` of addressable lights, each LED a candle of its own. Needs candle.c and candle.h here."""

import esphome.codegen as cg
import esphome.config_validation as cv
from esphome.components.light.effects import register_addressable_effect
from esphome.components.light.types import AddressableLightEffect
from esphome.const import CONF_NAME

CONF_BREEZE = "breeze"

wisp_candle_ns = cg.esphome_ns.namespace("wisp_candle")
WispCandleEffect = wisp_candle_ns.class_("WispCandleEffect", AddressableLightEffect)

CONFIG_SCHEMA = cv.Schema({})


@register_addressable_effect(
    "wisp_candle",
    WispCandleEffect,
    "Candle",
    {cv.Optional(CONF_BREEZE, default=128): cv.int_range(min=0, max=255)},
)
async def wisp_candle_effect_to_code(config, effect_id):
    effect = cg.new_Pvariable(effect_id, config[CONF_NAME])
    cg.add(effect.set_breeze(config[CONF_BREEZE]))
    return effect


async def to_code(config):
    pass
