// Usage: node validate.mjs FOLDER FILE: by the gltf-validator in FOLDER/node_modules. Prints "N errors, M triangles" and the
// first errors.
import { createRequire } from 'module';
import { readFileSync } from 'fs';
const [folder, file] = process.argv.slice(2);
const validator = createRequire(folder + '/')('gltf-validator');
const report = await validator.validateBytes(new Uint8Array(readFileSync(file)), { maxIssues: 0 });
console.log(`${report.issues.numErrors} errors, ${report.info.totalTriangleCount} triangles`);
for (const issue of report.issues.messages.filter(m => m.severity === 0).slice(0, 5))
    console.log(`${issue.pointer}: ${issue.message}`);
