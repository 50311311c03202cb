// export/…: what grows as a glTF file in memory, beside the second that a million triangles may take.
#include <memory>

#include "tools/bench/bench.hpp"
#include "tools/document/document.hpp"
#include "tools/export/export.hpp"

namespace espalier {
namespace {

constexpr double kMillionMs = 1000;

struct ExportTimes {
    double gather = 0, encode = 0;  // seconds
    exporting::Written written;
    std::string error;
};

ExportTimes timeExport(EspContext* context, const exporting::Options& options) {
    ExportTimes times;
    exporting::Gathered gathered;
    std::string bytes;
    bool good = true;
    times.gather = seconds([&] { good = exporting::gather(context, options, gathered, times.error); });
    if (!good) return times;
    times.encode = seconds([&] {
        (void)exporting::encode(
            gathered, options, [](float) { return true; }, bytes, times.written, times.error);
    });
    return times;
}

}  // namespace

void exportCases(Bench& bench) {
    for (const bool instancing : {false, true}) {
        const std::string name = instancing ? "export/guided/instancing" : "export/guided";
        if (!bench.wants(name)) continue;
        EspContextDef def = esp::defaults<EspContextDef>();
        def.log = [](void*, EspLogLevel, const char*) {};
        EspContext* made = nullptr;
        if (espCreate(ESP_VERSION, &def, &made) != ESP_OK) return bench.skip(name, espLastError(nullptr));
        const std::unique_ptr<EspContext, void (*)(EspContext*)> context(made, espDestroy);
        document::Document document(made);
        scene::Request request;
        request.file = bench.options().contentFolder + "/guided.json";
        std::string error;
        if (!document.open(request, error)) return bench.skip(name, error);
        if (espUpdate(made) != ESP_OK) return bench.skip(name, espLastError(made));
        exporting::Options options;
        options.instancing = instancing;
        std::vector<double> gather, whole;
        exporting::Written written;
        for (int i = -1; i < bench.options().repeats; ++i) {
            const ExportTimes times = timeExport(made, options);
            if (!times.error.empty()) return bench.skip(name, times.error);
            written = times.written;
            if (i < 0) continue;
            gather.push_back(times.gather * 1e3);
            whole.push_back((times.gather + times.encode) * 1e3);
        }
        const double millions = double(written.triangles) * 1e-6;
        bench.add({name, "triangles as glTF", "ms", median(whole), "a second a million", kMillionMs * millions});
        bench.add({name + "/gather", "their parts gathered", "ms", median(gather), "of all", median(whole)});
        bench.add({name + "/size", "size of the file", "MB", double(written.bytes) * 1e-6, "bound", 10});
    }
}

}  // namespace espalier
