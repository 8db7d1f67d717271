#include "compiler/cli/test/lsp_client.h"
#include "compiler/cli/test/support.h"

#include <algorithm>
#include <set>

namespace scc::cli::test {
namespace {

constexpr const char* uri = "file:///nowhere/a.scn";

/// A text with `|` where the cursor stands, which is taken out.
struct Marked {
    std::string text;
    Json position;

    explicit Marked(std::string marked) : text(std::move(marked)) {
        const std::size_t at = text.find('|');
        text.erase(at, 1);
        const std::size_t line_begin = text.rfind('\n', at == 0 ? 0 : at - 1) + 1;
        position = {{"line", std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n')},
                    {"character", at == 0 ? 0 : at - line_begin}};
    }
};

Json range(int line, int begin, int end) {
    return {{"start", {{"line", line}, {"character", begin}}}, {"end", {{"line", line}, {"character", end}}}};
}

class Lsp : public testing::Test {
protected:
    Json at(const std::string& method, const Marked& marked, Json more = Json::object()) {
        open(marked.text);
        more["textDocument"] = {{"uri", uri}};
        more["position"] = marked.position;
        return client.request(method, std::move(more));
    }
    void open(const std::string& text) {
        if (!initialized_) {
            client.initialize(capabilities);
            initialized_ = true;
        }
        client.open(uri, text, ++version);
    }
    std::set<std::string> labels(const std::string& marked) {
        const Json answer = at("textDocument/completion", Marked(marked));
        std::set<std::string> all;
        for (const Json& item : answer["result"]["items"]) {
            all.insert(item["label"]);
        }
        return all;
    }
    Json item(const std::string& marked, const std::string& label) {
        const Json answer = at("textDocument/completion", Marked(marked));
        for (const Json& one : answer["result"]["items"]) {
            if (one["label"] == label) {
                return one;
            }
        }
        ADD_FAILURE() << label << " is not offered";
        return {};
    }
    std::string hover(const std::string& marked) {
        const Json answer = at("textDocument/hover", Marked(marked));
        return answer["result"].is_null() ? "" : answer["result"]["contents"]["value"].get<std::string>();
    }
    /// The text after a rename; what the server refused with otherwise.
    std::string renamed(const std::string& marked, const std::string& name) {
        const Marked place(marked);
        const Json answer = at("textDocument/rename", place, {{"newName", name}});
        return answer.contains("error") ? answer["error"]["message"].get<std::string>()
                                        : edited(place.text, answer["result"]["changes"][uri]);
    }
    /// ASCII texts only.
    static std::string edited(std::string text, const Json& edits) {
        const auto offset = [&](const Json& position) {
            std::size_t at = 0;
            for (int line = position["line"]; line > 0; --line) {
                at = text.find('\n', at) + 1;
            }
            return at + position["character"].get<std::size_t>();
        };
        for (auto edit = edits.rbegin(); edit != edits.rend(); ++edit) {
            const std::size_t begin = offset((*edit)["range"]["start"]);
            text.replace(begin, offset((*edit)["range"]["end"]) - begin,
                         (*edit)["newText"].get<std::string>());
        }
        return text;
    }

    LspClient client;
    Json capabilities = Json::object();
    int version = 0;

private:
    bool initialized_ = false;
};

bool has(const std::set<std::string>& labels, const std::string& label) {
    return labels.count(label) == 1;
}

// ---- life of the server ---------------------------------------------------------------------------------

TEST_F(Lsp, EndsWithStatus0AfterShutdownAndExit) {
    const Json answer = client.initialize();
    EXPECT_EQ(answer["serverInfo"]["name"], "scc");
    EXPECT_EQ(answer["capabilities"]["positionEncoding"], "utf-16");
    EXPECT_TRUE(client.result("shutdown", nullptr).is_null());
    EXPECT_EQ(client.request("textDocument/hover", Json::object())["error"]["code"], -32600);
    client.notify("exit", nullptr);
    EXPECT_EQ(client.status(), 0);
}

TEST_F(Lsp, EndsWithStatus1WithoutShutdown) {
    client.initialize();
    client.notify("exit", nullptr);
    EXPECT_EQ(client.status(), 1);
}

TEST_F(Lsp, EndsAtTheEndOfTheInputInTheMiddleOfAMessage) {
    client.initialize();
    client.send_bytes("Content-Length: 1000\r\n\r\n{\"jsonrpc\"");
    client.hang_up();
    EXPECT_EQ(client.status(), 1);
}

TEST_F(Lsp, RefusesRequestsBeforeInitialize) {
    EXPECT_EQ(client.request("textDocument/hover", Json::object())["error"]["code"], -32002);
    client.open(uri, "sphere { }");
    client.initialize();
    EXPECT_EQ(client.request("initialize", Json::object())["error"]["code"], -32600);
}

TEST_F(Lsp, AnswersUnknownMethodsAndBadParameters) {
    client.initialize();
    EXPECT_EQ(client.request("textDocument/inlayHint", Json::object())["error"]["code"], -32601);
    EXPECT_EQ(client.request("textDocument/hover", Json::object())["error"]["code"], -32602);
    EXPECT_EQ(client.request("textDocument/hover", Json::array({1, 2}))["error"]["code"], -32602);
    const Json not_open{{"textDocument", {{"uri", "file:///b.scn"}}},
                        {"position", {{"line", 0}, {"character", 0}}}};
    EXPECT_EQ(client.request("textDocument/hover", not_open)["error"]["code"], -32602);
    client.notify("textDocument/didChange", {{"textDocument", 3}});
    client.notify("$/setTrace", {{"value", "off"}});
    client.open(uri, "sphere { }");
    Json bad{{"textDocument", {{"uri", uri}}}, {"position", {{"line", -1}, {"character", 0}}}};
    EXPECT_EQ(client.request("textDocument/hover", bad)["error"]["code"], -32602);
    bad["position"] = {{"line", 1e300}, {"character", "x"}};
    EXPECT_EQ(client.request("textDocument/hover", bad)["error"]["code"], -32602);
    bad["position"] = {{"line", 4000000000u}, {"character", 4000000000u}};
    EXPECT_TRUE(client.result("textDocument/hover", bad).is_null());
}

TEST_F(Lsp, SurvivesBrokenMessages) {
    client.initialize();
    client.send_bytes("Content-Length: 9\r\n\r\n{\"a\": 1,,");
    EXPECT_EQ(client.receive()["error"]["code"], -32700);
    client.send_bytes("Content-Length: 2\r\n\r\n[]");
    EXPECT_EQ(client.receive()["error"]["code"], -32600);
    client.send_bytes("Content-Length: 4\r\n\r\nnull");
    EXPECT_EQ(client.receive()["error"]["code"], -32600);
    client.send({{"id", {{"a", 1}}}, {"method", "shutdown"}});
    EXPECT_EQ(client.receive()["error"]["code"], -32600);
    const std::string deep(100'000, '[');
    client.send_bytes(lang::lsp::Framing::framed(deep));
    EXPECT_EQ(client.receive()["error"]["code"], -32700);
    client.send_bytes(lang::lsp::Framing::framed("{\"method\": \"a\xff\"}"));
    EXPECT_EQ(client.receive()["error"]["code"], -32700);
    EXPECT_TRUE(client.result("shutdown", nullptr).is_null());
}

TEST_F(Lsp, FindsTheNextMessageAfterAWrongLength) {
    client.initialize();
    client.send_bytes("Content-Length: 5\r\n\r\n{\"jsonrpc\": \"2.0\", \"method\": \"x\"}"); // too small
    const int first = client.ask("textDocument/hover", Json::object());
    EXPECT_EQ(client.receive()["error"]["code"], -32700);
    EXPECT_EQ(client.answer(first)["error"]["code"], -32602);
    for (const char* length : {"-4", "x", "99999999999999999999999", "999999999999", ""}) {
        client.send_bytes(std::string("Content-Length: ") + length + "\r\n\r\n{}\r\n");
    }
    EXPECT_TRUE(client.result("shutdown", nullptr).is_null());
}

TEST_F(Lsp, AnswersACancelledRequestAsCancelled) {
    client.initialize();
    std::string text;
    for (int i = 0; i < 3000; ++i) {
        text += "sphere { center = (" + std::to_string(i) + ", 0, 0) }\n";
    }
    client.open(uri, text);
    const Json request{
        {"jsonrpc", "2.0"},
        {"id", "hover-1"},
        {"method", "textDocument/hover"},
        {"params", {{"textDocument", {{"uri", uri}}}, {"position", {{"line", 0}, {"character", 1}}}}}};
    const Json cancel{{"jsonrpc", "2.0"}, {"method", "$/cancelRequest"}, {"params", {{"id", "hover-1"}}}};
    client.send_bytes(lang::lsp::Framing::framed(request.dump()) + lang::lsp::Framing::framed(cancel.dump()));
    Json answer = client.receive();
    while (answer.value("id", Json()) != "hover-1") {
        answer = client.receive();
    }
    EXPECT_EQ(answer["error"]["code"], -32800);
}

TEST_F(Lsp, ChecksOnlyTheLastOfManyChanges) {
    client.initialize();
    client.open(uri, "sphere { }\n");
    std::string changes;
    for (int i = 2; i <= 200; ++i) {
        changes += lang::lsp::Framing::framed(
            Json{{"jsonrpc", "2.0"},
                 {"method", "textDocument/didChange"},
                 {"params",
                  {{"textDocument", {{"uri", uri}, {"version", i}}},
                   {"contentChanges", {{{"range", range(0, 0, 0)}, {"text", " "}}}}}}}
                .dump());
    }
    client.send_bytes(changes);
    client.diagnostics(uri, 200);
    EXPECT_LT(client.said().size(), 20u);
}

// ---- diagnostics -----------------------------------------------------------------------------------------

TEST_F(Lsp, PublishesWhatCheckSays) {
    open("sphere { radios = 2 }\nlet a = 1\nperspective_camera { }\npoint_light { }\n");
    const Json list = client.diagnostics(uri, 1);
    ASSERT_EQ(list.size(), 2u) << list.dump();
    EXPECT_EQ(list[0]["range"], range(0, 9, 15));
    EXPECT_EQ(list[0]["severity"], 1);
    EXPECT_EQ(list[0]["code"], "unknown-field");
    EXPECT_EQ(list[0]["message"], "sphere has no field `radios`; did you mean `radius`?");
    EXPECT_EQ(list[1]["range"], range(1, 4, 5));
    EXPECT_EQ(list[1]["severity"], 2);
    EXPECT_EQ(list[1]["code"], "unused-let");
    client.replace_all(uri, "sphere { radius = 2 }\nperspective_camera { }\npoint_light { }\n", 2);
    EXPECT_EQ(client.diagnostics(uri, 2), Json::array());
}

TEST_F(Lsp, GivesNotesAsRelatedPlacesOrInTheMessage) {
    const std::string text = "sphere { radius = 1\nradius = 2 }\n";
    capabilities = {{"textDocument", {{"publishDiagnostics", {{"relatedInformation", true}}}}}};
    open(text);
    const Json list = client.diagnostics(uri, 1);
    const Json note = list[0]["relatedInformation"][0];
    EXPECT_EQ(note["location"], (Json{{"uri", uri}, {"range", range(0, 9, 15)}}));
    EXPECT_EQ(note["message"], "it is set here");
    LspClient plain;
    plain.initialize();
    plain.open(uri, text);
    EXPECT_EQ(plain.diagnostics(uri, 1)[0]["message"],
              "`radius` is set already\nnote: /nowhere/a.scn:1:10: it is set here");
}

TEST_F(Lsp, CountsColumnsInUtf16OrUtf8) {
    // The comment holds 8 characters: 1 + 2 + 4 bytes and so on; in UTF-16 the last one takes two units.
    const std::string text = "/* \xC3\xA9\xE2\x82\xAC\xF0\x9F\x98\x80 */ sphere { radios = 2 }\n";
    open(text);
    EXPECT_EQ(client.diagnostics(uri, 1)[0]["range"], range(0, 20, 26));
    LspClient other;
    const Json offered{{"general", {{"positionEncodings", {"utf-32", "utf-8", "utf-16"}}}}};
    EXPECT_EQ(other.initialize(offered)["capabilities"]["positionEncoding"], "utf-8");
    other.open(uri, text);
    EXPECT_EQ(other.diagnostics(uri, 1)[0]["range"], range(0, 25, 31));
    // An edit behind the same characters, in UTF-16.
    client.notify("textDocument/didChange", {{"textDocument", {{"uri", uri}, {"version", 2}}},
                                             {"contentChanges",
                                              {{{"range", range(0, 24, 25)}, {"text", "u"}},
                                               {{"range", range(0, 3, 7)}, {"text", ""}}}}});
    const Json hover = client.result("textDocument/hover", {{"textDocument", {{"uri", uri}}},
                                                            {"position", {{"line", 0}, {"character", 18}}}});
    EXPECT_EQ(hover["range"], range(0, 16, 22)) << hover.dump();
}

TEST_F(Lsp, AppliesIncrementalChangesOneAfterTheOther) {
    open("sphere { radius = 1 }\r\n// end\n");
    client.notify(
        "textDocument/didChange",
        {{"textDocument", {{"uri", uri}, {"version", 2}}},
         {"contentChanges",
          {{{"range", range(0, 0, 6)}, {"text", "box"}},
           {{"range",
             {{"start", {{"line", 0}, {"character", 3}}}, {"end", {{"line", 1}, {"character", 99}}}}},
            {"text", " { radius = 1 }\nbox { }"}}}}});
    const Json list = client.diagnostics(uri, 2);
    ASSERT_FALSE(list.empty());
    EXPECT_EQ(list[0]["message"], "box has no field `radius`");
    EXPECT_EQ(list[0]["range"], range(0, 6, 12));
}

TEST_F(Lsp, OffersFixes) {
    const std::string text = "sphere { radios = 2 }\nperspective_camera { fov_y = 40 }\npoint_light { }\n";
    open(text);
    const Json context{{"diagnostics", Json::array()}};
    const Json all =
        client.result("textDocument/codeAction",
                      {{"textDocument", {{"uri", uri}}}, {"range", range(0, 10, 10)}, {"context", context}});
    ASSERT_EQ(all.size(), 2u) << all.dump();
    EXPECT_EQ(all[0]["kind"], "quickfix");
    EXPECT_EQ(all[0]["title"], "replace `radios` by `radius`");
    EXPECT_EQ(all[0]["diagnostics"][0]["code"], "unknown-field");
    EXPECT_EQ(edited(text, all[0]["edit"]["changes"][uri]).substr(0, 15), "sphere { radius");
    EXPECT_EQ(all[1]["kind"], "source.fixAll");
    EXPECT_EQ(edited(text, all[1]["edit"]["changes"][uri]),
              "sphere { radius = 2 }\nperspective_camera { fov_y = 40deg }\npoint_light { }\n");
}

TEST_F(Lsp, ClearsTheDiagnosticsOfAClosedDocument) {
    open("sphere {");
    EXPECT_FALSE(client.diagnostics(uri, 1).empty());
    client.notify("textDocument/didClose", {{"textDocument", {{"uri", uri}}}});
    const Json last = client.receive();
    EXPECT_EQ(last["params"], (Json{{"uri", uri}, {"diagnostics", Json::array()}}));
}

// ---- completion ------------------------------------------------------------------------------------------

TEST_F(Lsp, CompletesFieldsThatAreNotSet) {
    const auto fields = labels("sphere {\n  radius = 2\n  |\n}\n");
    EXPECT_TRUE(has(fields, "center") && has(fields, "material") && has(fields, "let"));
    EXPECT_FALSE(has(fields, "radius") || has(fields, "sphere") || has(fields, "fov_y"));
    const Json radius = item("sphere { ra| }\n", "radius");
    EXPECT_EQ(radius["detail"], "radius: number = 1");
    EXPECT_NE(radius["documentation"]["value"].get<std::string>().find("A radius is greater than 0"),
              std::string::npos);
    EXPECT_EQ(radius["textEdit"], (Json{{"range", range(0, 9, 11)}, {"newText", "radius = "}}));
    EXPECT_TRUE(has(labels("sphere { if (true) { | } }\n"), "center"));
    EXPECT_TRUE(has(labels("sphere { |"), "center")); // never closed
    EXPECT_TRUE(has(labels("phong { | }\n"), "bump"));
    EXPECT_TRUE(has(labels("point_light { | }\n"), "power"));
}

TEST_F(Lsp, CompletesChoices) {
    const std::string scene = "render { method = raster { shading = \"|\" } }\n";
    EXPECT_EQ(labels(scene), (std::set<std::string>{"flat", "gouraud", "phong", "wireframe", "hidden_line"}));
    EXPECT_EQ(item("render { method = raster { shading = \"go|u\" } }\n", "gouraud")["textEdit"]["range"],
              range(0, 38, 41));
    EXPECT_TRUE(has(labels("render { method = raster { shading = | } }\n"), "\"gouraud\""));
    EXPECT_TRUE(labels("render { file = \"|\" }\n").empty());
}

TEST_F(Lsp, CompletesNamesInScope) {
    const std::string head = "param n: number = 3\nlet red = phong { }\nfn f(a: number, b: vec3) -> number = "
                             "a + |\nfn g(c: number) = c\n";
    const auto names = labels(head);
    for (const char* name : {"n", "red", "f", "g", "a", "b", "sin", "rgb", "pi", "if", "sphere"}) {
        EXPECT_TRUE(has(names, name)) << name;
    }
    EXPECT_FALSE(has(names, "c"));
    EXPECT_EQ(item(head, "g")["detail"], "fn g(c: number) -> number");
    EXPECT_TRUE(has(labels("for (i in 0..3) { sphere { radius = | } }\n"), "i"));
    EXPECT_FALSE(has(labels("for (i in 0..3) { sphere { } }\nlet a = |\n"), "i"));
    EXPECT_FALSE(has(labels("let a = |\n"), "a"));
    EXPECT_TRUE(has(labels("let l = [for (i in 0..3) |]\n"), "i"));
}

TEST_F(Lsp, PutsWhatFitsTheFieldFirst) {
    const std::string scene = "let red = phong { }\nlet size = 2\nsphere { material = | }\n";
    EXPECT_EQ(item(scene, "red")["sortText"], "0red");
    EXPECT_EQ(item(scene, "phong")["sortText"], "0phong");
    EXPECT_EQ(item(scene, "size")["sortText"], "1size");
    EXPECT_FALSE(has(labels(scene), "sphere"));
}

TEST_F(Lsp, CompletesMembersAndTypes) {
    EXPECT_EQ(labels("fn f(v: vec3) -> number = v.|\n"), (std::set<std::string>{"x", "y", "z"}));
    EXPECT_EQ(labels("fn f(s: surface) -> number = s.p.|\nsphere { }\n"),
              (std::set<std::string>{"x", "y", "z"}));
    EXPECT_TRUE(has(labels("fn f(s: surface) = s.|\n"), "world"));
    EXPECT_TRUE(has(labels("let c: |\n"), "color"));
    EXPECT_TRUE(has(labels("fn f(a: number) -> |\n"), "vec3"));
}

TEST_F(Lsp, CompletesNothingWhereNamesAreMadeUp) {
    for (const char* place :
         {"// a |\n", "/* | */\n", "let |\n", "fn f(|\n", "for (|\n", "let a = 12|\n", "let a = #12|\n"}) {
        EXPECT_TRUE(labels(place).empty()) << place;
    }
}

TEST_F(Lsp, PlacesTheCursorForClientsThatKnowSnippets) {
    capabilities = {{"textDocument", {{"completion", {{"completionItem", {{"snippetSupport", true}}}}}}}};
    EXPECT_EQ(item("|", "sphere")["textEdit"]["newText"], "sphere { $0 }");
    EXPECT_EQ(item("let a = |", "sin")["textEdit"]["newText"], "sin($0)");
}

// ---- names -----------------------------------------------------------------------------------------------

TEST_F(Lsp, TellsWhatANameIs) {
    EXPECT_EQ(hover("sphere { radi|us = 2 }\n"),
              "```scn\nradius: number = 1\n```\nRadius.\n\nA radius is greater than 0.");
    EXPECT_NE(hover("let r|ed = 2 * 3\nsphere { radius = red }\n").find("let red: number = 6"),
              std::string::npos);
    EXPECT_NE(hover("param n: number = 4 \"how many\"\nsphere { radius = |n }\n")
                  .find("param n: number = 4\n```\nhow many"),
              std::string::npos);
    EXPECT_NE(hover("fn f(a: number, b: vec3 = (1, 2, 3)) = a\nsphere { radius = f|(1) }\n")
                  .find("fn f(a: number, b: vec3 = (1, 2, 3)) -> number"),
              std::string::npos);
    EXPECT_NE(hover("fn f(a: number) = |a\n").find("a: number"), std::string::npos);
    EXPECT_NE(hover("let a = si|n(1)\n").find("sin("), std::string::npos);
    EXPECT_NE(hover("|phong { }\n").find("phong { diffuse, ambient"), std::string::npos);
    EXPECT_NE(hover("fn f(s: surface) = s.p.|x\n").find("x: number"), std::string::npos);
    EXPECT_EQ(hover("sphere |{ }\n"), "");
    EXPECT_EQ(hover("// wor|d\n"), "");
}

TEST_F(Lsp, FindsDefinitionsAndReferences) {
    const std::string text = "let a = 1\nfn f(a: number) = a\nsphere { radius = f(a = a) + (a) }\n";
    const Json place = at("textDocument/definition",
                          Marked("let a = 1\nfn f(a: number) = a\nsphere { radius = f(a = |a) + (a) }\n"));
    EXPECT_EQ(place["result"], (Json{{"uri", uri}, {"range", range(0, 4, 5)}}));
    const Json outer = at("textDocument/references", Marked("let |a = 1\n" + text.substr(10)),
                          {{"context", {{"includeDeclaration", true}}}});
    const auto location = [](const Json& where) { return Json{{"uri", uri}, {"range", where}}; };
    EXPECT_EQ(outer["result"], Json::array({location(range(0, 4, 5)), location(range(2, 24, 25)),
                                            location(range(2, 30, 31))}));
    const Json inner = at("textDocument/documentHighlight",
                          Marked("let a = 1\nfn f(|a: number) = a\nsphere { radius = f(a = a) + (a) }\n"));
    ASSERT_EQ(inner["result"].size(), 3u);
    EXPECT_EQ(inner["result"][0], (Json{{"range", range(1, 5, 6)}, {"kind", 3}}));
    EXPECT_EQ(inner["result"][2], (Json{{"range", range(2, 20, 21)}, {"kind", 2}}));
    EXPECT_TRUE(at("textDocument/definition", Marked("sph|ere { }"))["result"].is_null());
}

TEST_F(Lsp, LooksIntoImportedFiles) {
    const validation::ScratchFolder folder;
    const std::string path = (folder.path() / "studio.scn").string();
    host::replace_file(path, "param power: number = 1 in 0..9 \"of the lamp\"\nlet inner = 2\n");
    const std::string scene = "file://" + (folder.path() / "a.scn").string();
    const auto ask = [&](const char* method, const std::string& text) {
        const Marked marked(text);
        client.open(scene, marked.text, ++version);
        return client.request(method,
                              {{"textDocument", {{"uri", scene}}}, {"position", marked.position}})["result"];
    };
    open("");
    const std::string import = "import \"studio.scn\" as studio\n";
    const char* const definition = "textDocument/definition";
    const Json place{{"uri", "file://" + path}, {"range", range(0, 6, 11)}};
    EXPECT_EQ(ask(definition, import + "let a = studio.pow|er\n"), place);
    EXPECT_EQ(ask(definition, "import \"stu|dio.scn\" as studio\n"),
              (Json{{"uri", "file://" + path}, {"range", range(0, 0, 0)}}));
    EXPECT_EQ(ask(definition, import + "let a = stud|io.power\n")["uri"], scene);
    EXPECT_TRUE(ask(definition, import + "let a = (1, 2).|x\n").is_null());
    EXPECT_TRUE(ask(definition, "import \"no|ne.scn\" as studio\n").is_null());
    const std::string hover = ask("textDocument/hover", import + "let a = studio.|power\n").dump();
    EXPECT_NE(hover.find("param power: number"), std::string::npos) << hover;
    EXPECT_NE(hover.find("of the lamp"), std::string::npos) << hover;
    std::set<std::string> offered;
    const Json list = ask("textDocument/completion", import + "let a = studio.|\n");
    for (const Json& item : list["items"]) {
        offered.insert(item["label"]);
    }
    EXPECT_EQ(offered, (std::set<std::string>{"power", "inner", "scene"}));
    // What the editor has of it counts.
    client.open("file://" + path, "\nparam power: number = 1\n", ++version);
    EXPECT_EQ(ask(definition, import + "let a = studio.pow|er\n")["range"], range(1, 6, 11));
}

TEST_F(Lsp, RenamesInItsScopeOnly) {
    EXPECT_EQ(renamed("let |a = 1\nfn f(a: number) = a\nsphere { radius = f(a) + (a) }\n", "size"),
              "let size = 1\nfn f(a: number) = a\nsphere { radius = f(size) + (size) }\n");
    EXPECT_EQ(renamed("fn f(a: number) = |a * 2\nsphere { radius = f(a = 3) }\n", "factor"),
              "fn f(factor: number) = factor * 2\nsphere { radius = f(factor = 3) }\n");
    EXPECT_EQ(renamed("for (|i in 0..3) { sphere { radius = i + 1 } }\nlet l = [for (i in 0..2) i]\n", "k"),
              "for (k in 0..3) { sphere { radius = k + 1 } }\nlet l = [for (i in 0..2) i]\n");
    EXPECT_EQ(renamed("fn f(n: number) -> number {\n  let |twice = n * 2\n  twice + 1\n}\n", "t"),
              "fn f(n: number) -> number {\n  let t = n * 2\n  t + 1\n}\n");
    // Every line of a table is looked into.
    std::string lines, wanted;
    for (int i = 0; i < 300; ++i) {
        lines += "sphere { center = (" + std::to_string(i) + ", 0, 0), material = red }\n";
        wanted += "sphere { center = (" + std::to_string(i) + ", 0, 0), material = blue }\n";
    }
    EXPECT_EQ(renamed("let |red = phong { }\n" + lines, "blue"), "let blue = phong { }\n" + wanted);
}

TEST_F(Lsp, RefusesNamesThatWouldChangeTheMeaning) {
    const auto refused = [&](const std::string& text, const std::string& name, const std::string& why) {
        EXPECT_NE(renamed(text, name).find(why), std::string::npos) << name << ": " << renamed(text, name);
    };
    const std::string text = "let |a = 1\nlet b = a\nfn f(c: number) = a + c\nfn g(d: number) = d\nsphere { "
                             "radius = f(b) + g(1) }\n";
    refused(text, "2d", "is not a name");
    refused(text, "", "is not a name");
    refused(text, "n\xC3\xA9", "is not a name");
    refused(text, "let", "reserved word");
    refused(text, "sphere", "is a constructor");
    refused(text, "sin", "is a built-in function");
    refused(text, "pi", "is a constant");
    refused(text, "b", "bound in this scope already, in line 2");
    refused(text, "c", "is what line 3 binds");
    EXPECT_NE(renamed(text, "d").find("let d = 1"), std::string::npos); // `a` is not used where `d` is seen
    refused("let a = 1\nfn f(|c: number) = a + c\n", "a", "would hide the `a` of line 1");
    refused("|sphere { }\n", "ball", "only names that the file binds");
    refused("let |a = 1\nsphere { radius = ] a a a }\n", "b", "cannot be read");
}

TEST_F(Lsp, PreparesRenames) {
    const Json there = at("textDocument/prepareRename", Marked("let red = 1\nsphere { radius = re|d }\n"));
    EXPECT_EQ(there["result"], (Json{{"range", range(1, 18, 21)}, {"placeholder", "red"}}));
    EXPECT_TRUE(at("textDocument/prepareRename", Marked("sphere { ra|dius = 1 }\n"))["result"].is_null());
}

// ---- the whole file --------------------------------------------------------------------------------------

TEST_F(Lsp, LaysOutADocument) {
    const std::string text = "//\nlet   a=1\nsphere{radius=a}\nbox { }\n";
    open(text);
    const Json options{{"textDocument", {{"uri", uri}}},
                       {"options", {{"tabSize", 2}, {"insertSpaces", true}}}};
    const Json edits = client.result("textDocument/formatting", options);
    ASSERT_EQ(edits.size(), 1u);
    EXPECT_EQ(edits[0]["range"]["start"]["line"], 1); // the lines that differ, not all
    EXPECT_EQ(edited(text, edits), "//\nlet a = 1\nsphere { radius = a }\nbox { }\n");
    client.replace_all(uri, edited(text, edits), 2);
    EXPECT_EQ(client.result("textDocument/formatting", options), Json::array());
    client.replace_all(uri, "sphere { radius = \n", 3);
    EXPECT_TRUE(client.result("textDocument/formatting", options).is_null());
}

TEST_F(Lsp, OutlinesByPath) {
    open("let red = phong { }\nfn f(a: number) = a\ngroup {\n  name = \"table\"\n  box { name = \"leg\" }\n  "
         "box { name = \"leg\" }\n}\n"
         "for (i in 0..3) { sphere { radius = i + 1, material = red } }\nperspective_camera { }\n");
    const Json list = client.result("textDocument/documentSymbol", {{"textDocument", {{"uri", uri}}}});
    ASSERT_EQ(list.size(), 5u) << list.dump();
    EXPECT_EQ(list[0]["name"], "red");
    EXPECT_EQ(list[0]["detail"], "material");
    EXPECT_EQ(list[1]["detail"], "fn(number) -> number");
    EXPECT_EQ(list[2]["name"], "table");
    EXPECT_EQ(list[2]["children"][1]["name"], "table/leg[1]");
    EXPECT_EQ(list[3]["name"], "for i");
    EXPECT_EQ(list[3]["children"][0]["name"], "sphere[0] (of 3)");
    EXPECT_EQ(list[4]["name"], "perspective_camera");
}

TEST_F(Lsp, AnswersInTextThatCannotBeParsed) {
    const std::string broken =
        "let red = phong {\nsphere { material = re|d, radius = }\n)\nfn f(x: number = x +\n";
    EXPECT_NE(at("textDocument/completion", Marked(broken))["result"]["items"].size(), 0u);
    for (const char* method : {"textDocument/hover", "textDocument/definition", "textDocument/references",
                               "textDocument/documentSymbol"}) {
        EXPECT_FALSE(at(method, Marked(broken)).contains("error")) << method;
    }
    EXPECT_FALSE(client.diagnostics(uri, version).empty());
}

/// At every place of a scene, and of its beginnings, every question gets an answer.
TEST_F(Lsp, AnswersEverywhere) {
    const std::string text =
        "let red = phong { diffuse = #ff0000 }\nfn f(s: surface) -> color = if (s.p.x > 0) red else rgb(1, "
        "0, 0)\n"
        "for (i in 0..3) { sphere { radius = 1 + i, material = phong { diffuse = f } } }\n"
        "render { file = \"a.png\", method = ray { filter = \"box\" } }";
    for (std::size_t size = 0; size <= text.size(); size += 3) {
        open(text.substr(0, size));
        const auto lines = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(size), '\n');
        const std::size_t column = size - (size == 0 ? 0 : text.rfind('\n', size - 1) + 1);
        const Json parameters{{"textDocument", {{"uri", uri}}},
                              {"position", {{"line", lines}, {"character", column}}},
                              {"newName", "other"}};
        for (const char* method :
             {"textDocument/completion", "textDocument/hover", "textDocument/prepareRename"}) {
            EXPECT_FALSE(client.request(method, parameters).contains("error")) << method << " at " << size;
        }
        client.request("textDocument/rename", parameters);
    }
}

class LspFiles : public CommandLine {};

TEST_F(LspFiles, ReadsAssetsFromTheDocumentsFolder) {
    write("a b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    LspClient client;
    client.initialize();
    std::string here = "file://" + path("s%C3%A9.scn");
    client.open(here,
                "mesh { file = \"a b.obj\" }\nperspective_camera { }\npoint_light { }\n"); // never saved
    EXPECT_EQ(client.diagnostics(here, 1), Json::array());
    client.replace_all(here, "mesh { file = \"c.obj\" }\nperspective_camera { }\npoint_light { }\n", 2);
    EXPECT_EQ(client.diagnostics(here, 2)[0]["code"], "missing-asset");
    write("c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    client.notify("textDocument/didSave", {{"textDocument", {{"uri", here}}}});
    EXPECT_EQ(client.receive()["params"]["diagnostics"], Json::array());
}

TEST_F(LspFiles, ReadsABigDocument) {
    std::string text;
    for (int i = 0; i < 100'000; ++i) {
        text += "sphere { center = (" + std::to_string(i) + ", 0, 0), radius = 0.0625 }\n";
    }
    LspClient client;
    client.initialize();
    client.open(uri, text + "sphere { radios = 1 }\n");
    const Json list = client.diagnostics(uri, 1);
    ASSERT_GE(list.size(), 1u);
    EXPECT_EQ(list[0]["range"], range(100'000, 9, 15)); // an error, before thousands of warnings
    EXPECT_LE(list.size(), 1001u);
}

TEST_F(LspFiles, CommittedGrammarIsTheGeneratedOne) {
    const auto printed = scc({"lsp", "--print-grammar"});
    ASSERT_TRUE(printed.ok()) << printed.err;
    std::ifstream stream(SCC_SOURCE_DIR "/lang/editors/vscode/syntaxes/scn.tmLanguage.json",
                         std::ios::binary);
    const std::string committed{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    EXPECT_TRUE(committed == printed.out)
        << "write it anew: scc lsp --print-grammar > lang/editors/vscode/syntaxes/scn.tmLanguage.json";
}

TEST_F(LspFiles, ServesNeovim) {
    if (!validation::find_program("nvim")) {
        GTEST_SKIP() << "nvim is not installed; apt-get install neovim";
    }
    std::ifstream stream(example("lecture.scn"));
    std::string scene{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    scene.replace(scene.find("diffuse"), 7, "difuse");
    write("scene.scn", scene);
    const auto result = start(
        "nvim",
        {"--headless", "-u", "NONE", "-n", "-c", "luafile " SCC_SOURCE_DIR "/compiler/cli/test/neovim.lua"},
        {{"SCC_PROGRAM", SCC_PROGRAM}, {"XDG_STATE_HOME", folder().string()}});
    EXPECT_TRUE(result.ok()) << result.err << result.out;
    EXPECT_NE(result.out.find("all of it works"), std::string::npos) << result.err << result.out;
}

} // namespace
} // namespace scc::cli::test
