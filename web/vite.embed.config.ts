// SPDX-License-Identifier: Apache-2.0
// The viewer as a module of its own, without the page: eyrie.js, its worker and its types.
import { defineConfig } from "vite";

export default defineConfig({
  base: "./",
  publicDir: false,
  build: {
    target: "es2022",
    emptyOutDir: false,
    assetsInlineLimit: 0,
    modulePreload: false,
    rollupOptions: {
      input: { eyrie: "src/embed.ts" },
      preserveEntrySignatures: "strict",
      output: { entryFileNames: "[name].js", assetFileNames: "[name][extname]" },
    },
  },
  worker: {
    format: "es",
    rollupOptions: { output: { entryFileNames: "[name].js" } },
  },
  plugins: [
    {
      name: "types",
      generateBundle() {
        this.emitFile({
          type: "asset",
          fileName: "eyrie.d.ts",
          source: 'export * from "./types/embed";\n',
        });
      },
    },
  ],
});
