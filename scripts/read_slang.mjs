// SPDX-License-Identifier: Apache-2.0
// node read_slang.mjs YOSYS FOLDER COMMAND: runs a command of Yosys (YOSYS: the npm package's gen/bundle.js) in a copy of FOLDER, prints
// what it prints, and exits with 0 if the command succeeded.
import fs from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";

const [yosys, folder, command] = process.argv.slice(2);
const { runYosys } = await import(pathToFileURL(yosys).href);

function tree(root) {
  const found = {};
  for (const entry of fs.readdirSync(root, { withFileTypes: true })) {
    const name = path.join(root, entry.name);
    found[entry.name] = entry.isDirectory() ? tree(name) : fs.readFileSync(name);
  }
  return found;
}

const print = (bytes) => {
  if (bytes !== null) process.stdout.write(bytes);
};
try {
  await runYosys(["-Q", "-T", "-p", command], tree(folder), { stdout: print, stderr: print });
} catch (error) {
  console.log(error.message ?? error);
  process.exitCode = 1;
}
