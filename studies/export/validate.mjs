// Khronos' validator over .glb files: fails on an error or a warning.
//
//   node studies/export/validate.mjs FILE.glb…
import { readFile } from "node:fs/promises";
import validator from "gltf-validator";

let wrong = 0;
for (const path of process.argv.slice(2)) {
  const { issues } = await validator.validateBytes(new Uint8Array(await readFile(path)));
  console.log(`${path}: ${issues.numErrors} errors, ${issues.numWarnings} warnings`);
  for (const issue of issues.messages) {
    if (issue.severity <= 1) console.log(`  ${issue.code} ${issue.pointer}: ${issue.message}`);
  }
  wrong += issues.numErrors + issues.numWarnings;
}
process.exit(wrong === 0 && process.argv.length > 2 ? 0 : 1);
