-- Neovim's own client against `scc lsp`: started by lsp_test.cpp, in a folder with a scene.scn that has a mistake.
local program, scene = os.getenv("SCC_PROGRAM"), "scene.scn"

local function fail(text)
  io.stderr:write(text, "\n")
  vim.cmd("cquit 1")
end
local function expect(condition, text)
  if not condition then fail("not so: " .. text) end
end
local function wait_for(what, condition)
  expect(vim.wait(30000, condition, 20), what)
end
local function ask(method, parameters)
  local answers = vim.lsp.buf_request_sync(0, method, parameters, 30000)
  for _, answer in pairs(answers or {}) do return answer.result end
  fail("no answer to " .. method)
end

local function mistakes()
  return vim.diagnostic.get(0, { severity = vim.diagnostic.severity.ERROR })
end

vim.cmd("edit " .. scene)
local id = vim.lsp.start_client({ name = "scc", cmd = { program, "lsp" }, root_dir = vim.loop.cwd() })
vim.lsp.buf_attach_client(0, id)

wait_for("diagnostics come", function() return #mistakes() > 0 end)
local mistake = mistakes()[1]
expect(mistake.code == "unknown-field", vim.inspect(mistake))
expect(mistake.message:find("did you mean `diffuse`"), mistake.message)
local line = vim.api.nvim_buf_get_lines(0, mistake.lnum, mistake.lnum + 1, true)[1]
expect(line:sub(mistake.col + 1, mistake.end_col) == "difuse", line)

-- The fix, through the client's own machinery.
vim.api.nvim_win_set_cursor(0, { mistake.lnum + 1, mistake.col })
local place = vim.lsp.util.make_range_params()
place.context = { diagnostics = {} }
local fix = ask("textDocument/codeAction", place)[1]
vim.lsp.util.apply_workspace_edit(fix.edit, "utf-16")
wait_for("the mistake is mended", function() return #mistakes() == 0 end)

-- Hover over the field, then rename the material.
local hover = ask("textDocument/hover", vim.lsp.util.make_position_params())
expect(hover.contents.value:find("diffuse: color", 1, true), vim.inspect(hover))
vim.fn.search([[let \zsred]], "w")
local rename = vim.lsp.util.make_position_params()
rename.newName = "ruby"
vim.lsp.util.apply_workspace_edit(ask("textDocument/rename", rename), "utf-16")
local text = table.concat(vim.api.nvim_buf_get_lines(0, 0, -1, true), "\n")
expect(text:find("let ruby = phong", 1, true) and text:find("material = ruby", 1, true), text)
expect(not text:find("%f[%w]red%f[%W]"), "a `red` is left")

-- Formatting.
vim.api.nvim_buf_set_lines(0, -1, -1, true, { "sphere{radius=0.25}" })
local edits = ask("textDocument/formatting", vim.lsp.util.make_formatting_params({}))
vim.lsp.util.apply_text_edits(edits, 0, "utf-16")
local lines = vim.api.nvim_buf_get_lines(0, 0, -1, true)
expect(lines[#lines] == "sphere { radius = 0.25 }", lines[#lines])

local client = vim.lsp.get_client_by_id(id)
client.stop()
wait_for("the server ends", function() return client.is_stopped() end)
io.stdout:write("all of it works\n")
vim.cmd("qall!")
