// In: bytes. Out: nothing, if all goes well; each line of a run that is accepted is the same once it has been written
// and read again.
#include "tests/fuzz/promise.hpp"
#include "tools/document/run.hpp"

namespace espalier::fuzz {

void run(Bytes bytes) {
    const MemoryFile file(bytes);
    document::Run read;
    std::string error;
    if (!document::readRun(file.path(), read, error)) return require(!error.empty(), "a failure has a message");
    uint32_t before = 0;
    for (const document::RunLine& line : read.lines) {
        require(line.frame >= before, "frames never fall");
        before = line.frame;
        const std::string text = document::toJson(line);
        document::RunLine again;
        require(document::fromJson(text, again, error), "what was written can be read");
        require(document::toJson(again) == text, "and is the same");
    }
}

}  // namespace espalier::fuzz
