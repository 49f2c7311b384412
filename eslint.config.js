import js from "@eslint/js";
import globals from "globals";

export default [
  { ignores: ["node_modules/", ".venv*/", "build/", "dist/", "site/"] },
  js.configs.recommended,
  {
    files: ["service/explorer/page/js/*.js"],
    languageOptions: { sourceType: "module", globals: globals.browser },
  },
  {
    files: ["service/docs/*.js"],
    languageOptions: { sourceType: "script", globals: { ...globals.browser, SwaggerUIBundle: "readonly" } },
  },
  { files: ["scripts/docs_site/*.js"], languageOptions: { sourceType: "script", globals: globals.browser } },
  { files: ["tests/page/*.js", "eslint.config.js"], languageOptions: { sourceType: "module", globals: globals.node } },
  {
    rules: {
      curly: ["error", "multi-line"],
      eqeqeq: "error",
      "no-shadow": "error",
      "no-unused-vars": ["error", { args: "all", argsIgnorePattern: "^_$" }],
      "no-var": "error",
      "object-shorthand": "error",
      "prefer-const": "error",
    },
  },
];
