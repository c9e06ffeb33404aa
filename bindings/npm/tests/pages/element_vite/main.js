import '@wisp/player/candle';
import '@wisp/player/leaves';
