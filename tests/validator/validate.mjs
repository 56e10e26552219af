// Runs Khronos's validator over files: node validate.mjs FOLDER-OF-NODE-MODULES < a list of paths, one a line. Prints a JSON list:
// for each file its path, its triangles, and its errors as [code, pointer]; an entry with "failed" is no glTF at all to the validator.
import fs from "node:fs";
import path from "node:path";
import { createRequire } from "node:module";

const require = createRequire(path.join(process.argv[2], "resolve.js"));
const validator = require("gltf-validator");

async function look(file) {
    const external = (uri) =>
        new Promise((resolve, reject) => {
            fs.readFile(path.resolve(path.dirname(file), decodeURIComponent(uri)), (error, data) =>
                error ? reject(error.toString()) : resolve(new Uint8Array(data)));
        });
    const bytes = new Uint8Array(fs.readFileSync(file));
    try {
        const report = await validator.validateBytes(bytes, { uri: path.basename(file), maxIssues: 0, externalResourceFunction: external });
        const errors = report.issues.messages.filter((m) => m.severity === 0).map((m) => [m.code, m.pointer ?? ""]);
        const warnings = report.issues.messages.filter((m) => m.severity > 0).map((m) => [m.code, m.pointer ?? ""]);
        return { file, triangles: report.info?.totalTriangleCount ?? 0, required: report.info?.extensionsRequired ?? [], errors, warnings };
    } catch (problem) {
        return { file, failed: String(problem) };
    }
}

const files = fs.readFileSync(0, "utf8").split("\n").filter((line) => line);
const results = [];
for (const file of files) results.push(await look(file));
console.log(JSON.stringify(results));
