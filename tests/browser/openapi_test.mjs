// SPDX-License-Identifier: Apache-2.0
// The API's document, from a running server, is valid OpenAPI 3.1.
import { createRequire } from "node:module";
import { fileURLToPath, pathToFileURL } from "node:url";

import { ServerProcess, check, environment } from "./support.mjs";

const web = createRequire(fileURLToPath(new URL("../../web/package.json", import.meta.url)));
const { Validator } = await import(
  pathToFileURL(web.resolve("@seriousme/openapi-schema-validator"))
);

const server = await ServerProcess.start(
  environment("EYRIE_BINARY"),
  ["serve", environment("EYRIE_SCENE"), "--listen", "127.0.0.1:0", "--renderers", "1"],
  90,
);
try {
  const document = await (await fetch(`${server.url}api/v1/openapi.json`)).json();
  const validator = new Validator();
  const { valid, errors } = await validator.validate(document);
  check(valid, `the document is valid: ${JSON.stringify(errors ?? [])}`);
  check(validator.version === "3.1", "it is OpenAPI 3.1");
  delete document.info.title;
  check(!(await validator.validate(document)).valid, "one without a title is not");
} finally {
  await server.kill();
}
