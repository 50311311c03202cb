#pragma once

// Baking a folder of models: which ones, what is known of them already, processes that bake the rest, and the report.

#include <nlohmann/json.hpp>

#include "tools/bake/import_model.hpp"

namespace espalier::folder {

struct Options {
    std::string folder, out;
    ImportOptions importing;
    BakeOptions bake;
    std::string asked;  // every option that changes what is baked, as text: part of the cache's key
    unsigned jobs = 0;  // processes at once; 0: as many as there are cores
    unsigned shard = 1, shards = 1;
    bool quiet = false;
};

// A model of the folder. Paths are relative to the folder and to the output.
struct Item {
    std::string model, surface;
};

// All models below `folder` but not in `out`, sorted, the same list on every machine: .gltf, .glb, .obj, .ply, .ply.gz,
// .stl, without surfaces and hidden files. A surface is named after its model; where two would share a name, both keep
// their ending.
Result<std::vector<Item>> listModels(const std::string& folder, const std::string& out);

// What one model came to: the report's row.
// {"model", "outcome": "baked" | "refused" | "failed", "surface", "message", "report"}. `refused` is a fault of the
// model's and is remembered, `failed` one of the machine's (memory, disk, a crash) and is not.
using Row = nlohmann::ordered_json;

// What is known from earlier runs, in OUT/.cache. The key of an entry is a hash over the baker's program, the options,
// the model's name and the bytes of every file that was read for it, or was missing; which files those are is noted at
// each bake. Entries are never changed, so a cache may be shared, copied and deleted.
class Cache {
  public:
    explicit Cache(const Options& options);

    // Puts the model's surface into place and gives its row; null where it has to be baked.
    Row find(const Item& item);
    // Takes over what a bake left at `surface` (refusals: nothing) and puts it into place.
    Status store(const Item& item, const Row& row, const std::vector<InputFile>& inputs, const std::string& surface);

    const std::string& folder() const { return cache_; }

  private:
    std::string notePath(const Item& item) const;
    std::string keyOf(const Item& item, const std::vector<InputFile>& inputs) const;
    Status place(const std::string& entry, const Item& item);

    const Options& options_;
    std::string cache_;
    uint64_t baker_ = 0;  // over the program and the options
};

// One line a model, or a bar on a terminal. All to stderr.
class Progress {
  public:
    Progress(size_t total, bool quiet);
    ~Progress();
    void finished(const Row& row, bool known);
    void running(const std::vector<std::string>& models);

  private:
    void draw();
    size_t total_, done_ = 0, bad_ = 0;
    bool quiet_, bar_;
    std::string now_;
};

// OUT/report.json and OUT/report.txt: the same bytes for the same models and options, however they were baked.
Status writeReport(const Options& options, const std::vector<Row>& rows);

// Bakes the shard and, if that is everything, writes the report. The program's exit code: 0, 1 when a model was refused
// or failed, 130 when interrupted.
int run(const Options& options);

}  // namespace espalier::folder
