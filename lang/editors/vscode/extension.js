// A client of `scc lsp` without any dependency: starts it, hands over documents, and asks it what the editor asks.
const vscode = require("vscode");
const { spawn } = require("child_process");

const selector = { language: "scn" };
const isScene = (document) => document.languageId === "scn";
let server;

/// One server process and the requests that wait for its answers.
class Server {
  constructor(program, diagnostics) {
    this.waiting = new Map();
    this.lastId = 0;
    this.input = Buffer.alloc(0);
    this.diagnostics = diagnostics;
    this.process = spawn(program, ["lsp"], { stdio: ["pipe", "pipe", "inherit"] });
    this.process.on("error", () => this.lost(`cannot run ${program}: set "scn.program" to the path of scc`));
    this.process.on("exit", (code) => this.lost(code === 0 ? "" : `scc lsp ended with status ${code}`));
    this.process.stdin.on("error", () => {});
    this.process.stdout.on("data", (bytes) => this.receive(bytes));
  }
  lost(text) {
    this.waiting.forEach((wait) => wait.resolve(null));
    this.waiting.clear();
    if (text && server === this) vscode.window.showErrorMessage(text);
    if (server === this) server = undefined;
  }
  receive(bytes) {
    this.input = Buffer.concat([this.input, bytes]);
    for (;;) {
      const end = this.input.indexOf("\r\n\r\n");
      const length = end < 0 ? null : /Content-Length: (\d+)/i.exec(this.input.toString("ascii", 0, end));
      if (!length || this.input.length < end + 4 + Number(length[1])) return;
      const message = JSON.parse(this.input.toString("utf8", end + 4, end + 4 + Number(length[1])));
      this.input = this.input.subarray(end + 4 + Number(length[1]));
      this.handle(message);
    }
  }
  handle({ id, method, params, result, error }) {
    if (method === "textDocument/publishDiagnostics") {
      this.diagnostics.set(vscode.Uri.parse(params.uri), params.diagnostics.map(toDiagnostic));
    }
    const wait = method ? undefined : this.waiting.get(id);
    this.waiting.delete(id);
    if (wait) error ? wait.reject(new Error(error.message)) : wait.resolve(result);
  }
  send(message) {
    const text = JSON.stringify({ jsonrpc: "2.0", ...message });
    this.process.stdin.write(`Content-Length: ${Buffer.byteLength(text)}\r\n\r\n${text}`);
  }
  notify(method, params) {
    this.send({ method, params });
  }
  request(method, params) {
    const id = ++this.lastId;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve, reject });
      this.send({ id, method, params });
    });
  }
}

const fromPosition = ({ line, character }) => ({ line, character });
const fromRange = ({ start, end }) => ({ start: fromPosition(start), end: fromPosition(end) });
const toRange = ({ start, end }) => new vscode.Range(start.line, start.character, end.line, end.character);
const toLocation = ({ uri, range }) => new vscode.Location(vscode.Uri.parse(uri), toRange(range));
const toText = (markup) => markup && new vscode.MarkdownString(markup.value);
const toTextEdit = (edit) => new vscode.TextEdit(toRange(edit.range), edit.newText);
const kindOf = (kind) => kind - 1; // the protocol counts from 1, the editor from 0

function toDiagnostic(from) {
  const to = new vscode.Diagnostic(toRange(from.range), from.message, kindOf(from.severity));
  to.code = from.code;
  to.source = from.source;
  to.relatedInformation = (from.relatedInformation || []).map(
    (one) => new vscode.DiagnosticRelatedInformation(toLocation(one.location), one.message));
  return to;
}
function toWorkspaceEdit(from) {
  const to = new vscode.WorkspaceEdit();
  Object.entries(from.changes).forEach(([uri, edits]) => to.set(vscode.Uri.parse(uri), edits.map(toTextEdit)));
  return to;
}
function toCompletion(from) {
  const to = new vscode.CompletionItem(from.label, kindOf(from.kind));
  to.detail = from.detail;
  to.sortText = from.sortText;
  to.documentation = toText(from.documentation);
  to.range = toRange(from.textEdit.range);
  to.insertText = from.insertTextFormat === 2 ? new vscode.SnippetString(from.textEdit.newText) : from.textEdit.newText;
  return to;
}
function toSymbol(from) {
  const to = new vscode.DocumentSymbol(from.name, from.detail, kindOf(from.kind), toRange(from.range), toRange(from.selectionRange));
  to.children = from.children.map(toSymbol);
  return to;
}
function toAction(from) {
  const kind = from.kind === "quickfix" ? vscode.CodeActionKind.QuickFix : vscode.CodeActionKind.SourceFixAll;
  const to = new vscode.CodeAction(from.title, kind);
  to.edit = toWorkspaceEdit(from.edit);
  to.diagnostics = (from.diagnostics || []).map(toDiagnostic);
  to.isPreferred = from.isPreferred;
  return to;
}

/// Asks about a document, and about a place in it if there is one; nothing is the answer of a server that is gone.
async function ask(method, document, position, more, convert) {
  const params = { textDocument: { uri: document.uri.toString() }, ...more };
  if (position) params.position = fromPosition(position);
  const result = server ? await server.request(`textDocument/${method}`, params) : null;
  return result ? convert(result) : undefined;
}

async function activate(context) {
  const diagnostics = vscode.languages.createDiagnosticCollection("scc");
  server = new Server(vscode.workspace.getConfiguration("scn").get("program"), diagnostics);
  const capabilities = { textDocument: { completion: { completionItem: { snippetSupport: true } },
                                         publishDiagnostics: { relatedInformation: true } } };
  await server.request("initialize", { processId: process.pid, rootUri: null, capabilities });
  if (!server) return;
  server.notify("initialized", {});
  const open = (document) => isScene(document) && server && server.notify("textDocument/didOpen", { textDocument: {
    uri: document.uri.toString(), languageId: "scn", version: document.version, text: document.getText() } });
  const tell = (method, document, more) => isScene(document) && server &&
    server.notify(`textDocument/${method}`, { textDocument: { uri: document.uri.toString(), version: document.version }, ...more });
  vscode.workspace.textDocuments.forEach(open);
  const { workspace: w, languages: l } = vscode;
  context.subscriptions.push(
    diagnostics,
    w.onDidOpenTextDocument(open),
    w.onDidChangeTextDocument(({ document, contentChanges }) => tell("didChange", document, {
      contentChanges: contentChanges.map((change) => ({ range: fromRange(change.range), text: change.text })) })),
    w.onDidSaveTextDocument((document) => tell("didSave", document)),
    w.onDidCloseTextDocument((document) => tell("didClose", document)),
    l.registerCompletionItemProvider(selector, {
      provideCompletionItems: (d, p) => ask("completion", d, p, {}, (list) => list.items.map(toCompletion)) }, ".", '"'),
    l.registerHoverProvider(selector, {
      provideHover: (d, p) => ask("hover", d, p, {}, (h) => new vscode.Hover(toText(h.contents), toRange(h.range))) }),
    l.registerDefinitionProvider(selector, { provideDefinition: (d, p) => ask("definition", d, p, {}, toLocation) }),
    l.registerReferenceProvider(selector, {
      provideReferences: (d, p, context) => ask("references", d, p, { context }, (list) => list.map(toLocation)) }),
    l.registerRenameProvider(selector, {
      provideRenameEdits: (d, p, newName) => ask("rename", d, p, { newName }, toWorkspaceEdit),
      prepareRename: async (d, p) => {
        const place = await ask("prepareRename", d, p, {}, (r) => ({ range: toRange(r.range), placeholder: r.placeholder }));
        if (!place) throw new Error("only names that the file binds can be renamed");
        return place;
      } }),
    l.registerDocumentFormattingEditProvider(selector, {
      provideDocumentFormattingEdits: (d) => ask("formatting", d, null, { options: {} }, (list) => list.map(toTextEdit)) }),
    l.registerDocumentSymbolProvider(selector, {
      provideDocumentSymbols: (d) => ask("documentSymbol", d, null, {}, (list) => list.map(toSymbol)) }),
    l.registerCodeActionsProvider(selector, { provideCodeActions: (d, range) =>
      ask("codeAction", d, null, { range: fromRange(range), context: { diagnostics: [] } }, (list) => list.map(toAction)) }));
}

async function deactivate() {
  const last = server;
  server = undefined;
  if (last) {
    await last.request("shutdown", null);
    last.notify("exit", null);
  }
}

module.exports = { activate, deactivate };
