// Starts `labspec lsp` and hands it what the editor has. Everything else is the server's.

const { commands, workspace } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

async function start() {
  const settings = workspace.getConfiguration("labspec");
  const server = { command: settings.get("path"), args: ["lsp", ...settings.get("arguments")] };
  client = new LanguageClient("labspec", "labspec", server, {
    documentSelector: [
      { scheme: "file", language: "markdown" },
      { scheme: "file", language: "json" },
      { scheme: "file", pattern: "**/*.{mdx,qmd,Rmd}" },
      // Models.
      { scheme: "file", language: "xml" },
      { scheme: "file", pattern: "**/*.xml" },
    ],
    initializationOptions: settings,
    synchronize: {
      configurationSection: "labspec",
      fileEvents: workspace.createFileSystemWatcher("**/{*.xml,*.md,*.json,labspec.toml}"),
    },
  });
  await client.start();
}

async function stop() {
  const old = client;
  client = undefined;
  await old?.stop();
}

exports.activate = async (context) => {
  context.subscriptions.push(
    commands.registerCommand("labspec.restart", async () => {
      await stop();
      await start();
    }),
  );
  await start();
};

exports.deactivate = stop;
