// espalier-content OUT_DIR: generates Espalier's own sample content. In: nothing but options. Out: ruin.glb,
// mask.png, ivy.png, terminals.glb, roofs.glb, pieces.glb, a file of each form that patterns lie on, props.glb; with
// --town FILE and --grammar FILE, site.json and site.png; with --preview DIR, pictures.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "tools/command_line.hpp"
#include "tools/content/content.hpp"

using namespace espalier;

namespace {

int makeAsAsked(int argc, char** argv) {
    CLI::App app{
        "Generates Espalier's sample content: a ruin and its layers, what plants and roofs are made of, props; "
        "with --town also the site around it.",
        "espalier-content"};
    content::Options options;
    app.add_option(
           "OUT_DIR", options.directory,
           "folder for ruin.glb, its layers, terminals.glb, roofs.glb, pieces.glb, props.glb and forms for patterns; "
           "made if missing")
        ->required();
    app.add_option("--preview", options.previewDirectory, "folder for pictures of what was made");
    app.add_option("--textures", options.textureSize, "texels a side of the ruin's textures")
        ->check(CLI::IsMember({256, 512, 1024, 2048, 4096}));
    app.add_option("--only", options.only, "makes one of ruin, roofs, pieces, forms, terminals, props instead of all")
        ->check(CLI::IsMember({"ruin", "roofs", "pieces", "forms", "terminals", "props"}));
    CLI::Option* town =
        app.add_option("--town", options.town, "houses that the site is laid out around, --only or not");
    town->needs(
        app.add_option("--grammar", options.grammar, "of these houses, for where their doors are")->needs(town));
    app.set_version_flag("--version", "espalier-content " ESPALIER_VERSION);
    if (const auto ends = espalier::parseCommandLine(app, argc, argv)) return *ends;
    Status status = content::generate(options);
    if (!status) {
        std::fprintf(stderr, "espalier-content: %s\n", status.failure().text().c_str());
        return 1;
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return runProgram("espalier-content", [&] { return makeAsAsked(argc, argv); });
}
