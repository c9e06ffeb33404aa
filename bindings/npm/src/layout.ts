// Byte offsets of the fields of the C ABI's structs in WebAssembly memory. wasm/layout.cpp checks the compiler against
// the same numbers.

export const modelFacts = {
  size: 128,
  inputs: 4,
  outputs: 8,
  controlPoints: 12,
  usable: 16,
  rateHz: 24,
  metresPerUnit: 32,
  stepNanoseconds: 40,
  multiplyAddsPerFrame: 48,
  operationsPerFrame: 56,
  blowOutLevel: 64,
  blowOutSeconds: 72,
  dynamics: 80,
  view: 84,
  halfWidth: 88,
  halfLength: 96,
  blowOutHaste: 104,
  blowOutRecoverySeconds: 112,
  blowOutInput: 120,
} as const;

export const channel = { size: 40, name: 8, unit: 12, lowest: 16, highest: 24, evenOdd: 32 } as const;

export const provenance = { size: 32, sources: 4, options: 8, figures: 12, usable: 16, program: 24, reason: 28 } as const;

export const note = { size: 16, name: 8, value: 12 } as const;

export const figure = { size: 24, name: 8, value: 16 } as const;

export const arxFacts = { size: 20, outputs: 4, regressors: 8, history: 12, resamples: 16 } as const;

export const chainFacts = {
  size: 24,
  modes: 4,
  segments: 8,
  history: 12,
  gustOrder: 16,
  headingFree: 20,
} as const;

export const bankOptions = { size: 32, capacity: 4, polylinePoints: 8, longest: 12, seed: 16 } as const;

export const bankFacts = {
  size: 48,
  capacity: 4,
  alive: 8,
  slots: 12,
  inputs: 16,
  outputs: 20,
  polylinePoints: 24,
  clamped: 32,
  steps: 40,
} as const;

export const flameState = {
  size: 56,
  lit: 4,
  flameSize: 8,
  events: 12,
  sinceLit: 16,
  sinceOut: 24,
  light: 32,
  intensity: 44,
  kelvin: 48,
} as const;

export const chainPlace = {
  size: 48,
  segment: 4,
  step: 8,
  mode: 12,
  velocity: 16,
  spin: 28,
  lies: 40,
  landed: 44,
} as const;

export const chainSettings = { size: 12, hasGround: 4, ground: 8 } as const;

export const body = { size: 56, position: 4, orientation: 16, velocity: 32, spin: 44 } as const;

export const windOptions = {
  size: 56,
  channels: 4,
  rateHz: 8,
  frameRateHz: 16,
  exponent: 24,
  smoothingSeconds: 32,
  floorRiseDbPerSecond: 40,
  firstGustRms: 48,
} as const;

export const windFrame = {
  size: 40,
  index: 0,
  rms: 8,
  rmsClean: 12,
  level: 16,
  speed: 20,
  wind: 24,
  confidence: 28,
  background: 32,
  clipped: 36,
} as const;

export const windCalibration = { size: 20, backgroundRms: 4, backgroundLevel: 8, floorDb: 12, gustRms: 16 } as const;
