// Generates src/messages.d.ts from the message schema of the server: part of every `npm run build`, `npm run types` by itself.
// The file is not kept in the repository, so that it cannot fall behind the schema.
import { readFile, writeFile } from "node:fs/promises";
import { fileURLToPath } from "node:url";
import { compile } from "json-schema-to-typescript";

const schemaFile = fileURLToPath(new URL("../server/messages.schema.json", import.meta.url));
const outFile = fileURLToPath(new URL("src/messages.d.ts", import.meta.url));

export async function generateTypes() {
  const schema = JSON.parse(await readFile(schemaFile, "utf8"));
  return compile(schema, "FilumProtocol", {
    bannerComment: "// Generated from ../server/messages.schema.json by `npm run types`. Do not edit.",
    additionalProperties: false,
    format: false,
  });
}

if (process.argv[1] === fileURLToPath(import.meta.url)) await writeFile(outFile, await generateTypes());
