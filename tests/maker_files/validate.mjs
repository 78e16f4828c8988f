// What the Khronos glTF validator finds in a file, as JSON.
import { readFileSync } from "fs";
import validator from "gltf-validator";

const report = await validator.validateBytes(new Uint8Array(readFileSync(process.argv[2])));
console.log(JSON.stringify(report.issues));
