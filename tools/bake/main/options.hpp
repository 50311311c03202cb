#pragma once

// The command line of espalier-bake: what can be asked for, and of which kind of input.

#include <CLI/CLI.hpp>
#include <optional>

#include "tools/bake/import_model.hpp"
#include "tools/bake/main/carry_layers.hpp"
#include "tools/bake/main/town.hpp"

namespace espalier {

enum class InputKind { model, folder, town };

struct Arguments {
    std::string model, output, report, images, shard, weights;
    TownArguments town;
    CarryArguments carry;
    ImportOptions importing;
    BakeOptions bake;
    std::vector<double> origin;  // three, or none
    double tolerance = 0;
    unsigned jobs = 0;
    bool quiet = false;
    bool pieces = false;    // a palette is asked for
    bool terminal = false;  // a mesh for plants' terminals is asked for
};

void addOptions(CLI::App& app, Arguments& arguments);

// Why what was asked for can't be done to an input of this kind, whatever it holds; nothing: it can be.
std::optional<Failure> mistakeIn(const CLI::App& app, const Arguments& arguments, InputKind kind);

}  // namespace espalier
