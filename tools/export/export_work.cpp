// In: a context and a path. Out: a plan that copies its parts between frames, and encodes and writes them beside.
#include "tools/export/export_work.hpp"

#include <cstdio>

#include "tools/scene/text_file.hpp"

namespace espalier::exporting {
namespace {

constexpr float kEncoded = .9f;  // share of the time until all is encoded

std::string noteOf(const Written& written) {
    char text[128];
    std::snprintf(text, sizeof text, "%.2f million triangles, %.1f MB", double(written.triangles) * 1e-6,
                  double(written.bytes) * 1e-6);
    return text;
}

}  // namespace

document::Work::Plan exportingTo(EspContext* context, const Options& options, const std::string& path) {
    document::Work::Plan plan;
    const auto gathered = std::make_shared<Gathered>();
    const auto note = plan.note = std::make_shared<std::string>();
    plan.before.push_back(
        [context, options, gathered](std::string& error) { return gather(context, options, *gathered, error); });
    plan.beside = [gathered, note, options, path](document::Progress& progress, std::string& error) {
        std::string bytes;
        Written written;
        const auto goOn = [&](float share) { return progress.at(kEncoded * share); };
        if (!encode(*gathered, options, goOn, bytes, written, error)) {
            if (!error.empty()) error = path + ": " + error;
            return false;
        }
        *note = noteOf(written);
        return progress.at(kEncoded) && scene::writeText(path, bytes, error) && progress.at(1);
    };
    return plan;
}

}  // namespace espalier::exporting
