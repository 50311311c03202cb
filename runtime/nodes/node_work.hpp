#pragma once

// What a row of the table of kinds sees while it makes its node: inputs, memory, kernels to run, outputs.

#include <functional>

#include "runtime/nodes/machine.hpp"
#include "runtime/nodes/node_graph.hpp"
#include "runtime/nodes/wishes.hpp"

namespace espalier {

// A block that a node keeps from one evaluation to the next.
struct NodeSlot {
    BlockRef block;
    uint64_t madeFrom = 0;  // what its contents follow from; 0: they are made anew each time
};

// What a node keeps besides, such as how far a simulation has come.
struct NodeMemory {
    virtual ~NodeMemory() = default;
};
struct NodeKept {
    std::vector<NodeSlot> slots;
    std::unique_ptr<NodeMemory> memory;
};

// One time of several in which nodes are made.
struct LoopPass {
    uint32_t index = 0, count = 1;
    glm::vec3 place{0};                  // where what it gives stands, if that is asked for
    const NodeValue* carried = nullptr;  // what the pass before gave; null: it is the first
};

struct GraphTime {
    double frame = 0;        // a whole number
    double step = 1.0 / 30;  // seconds from one frame to the next
    bool operator==(const GraphTime&) const = default;
};

// A file that a graph names, as it was found.
struct NodeFile {
    std::string path;
    std::vector<std::byte> bytes;
};
// Finds and reads the file that the graph's file names, or says why it can't.
using NodeFiles = std::function<Result<NodeFile>(const std::string& graphFile, const std::string& name)>;

// Elements and instances of one graph at most.
constexpr uint32_t kMostNodeElements = 1u << 26, kMostNodeInstances = 1000000;

class NodeWork {
  public:
    struct Given {
        const NodeKind& kind;
        std::span<const Literal> constants;
        std::vector<std::vector<const NodeValue*>> wires;  // [port]
        GraphTime time;
        const NodeFiles& files;
        const std::string& graphFile;
        const LoopPass* pass = nullptr;  // of an opener: the pass that it opens; null: none does
        // Of a node that repeats: makes a pass, and which outputs of the opener its nodes read.
        std::function<Result<const NodeValue*>(const LoopPass&)> makePass = {};
        uint32_t passReads = 0;
    };
    NodeWork(Given given, NodeMachine& machine, NodeKept& kept, NodeWorkList& list)
        : given_(std::move(given)), machine_(machine), kept_(kept), list_(list), outputs_(given_.kind.outputs.size()) {}

    // Inputs by their ports' names. A wired number that is out of the port's range is drawn to its nearest end.
    float number(const char* port) const;
    uint32_t whole(const char* port) const { return uint32_t(number(port)); }
    glm::vec3 vector(const char* port) const;
    const std::string& text(const char* port) const;
    uint32_t choice(const char* port) const;  // which of its words
    bool wired(const char* port) const { return !wires(port).empty(); }
    const Geometry& geometry(const char* port) const { return std::get<Geometry>(*wires(port).front()); }
    const MaterialLook& material(const char* port) const { return std::get<MaterialLook>(*wires(port).front()); }
    // Null: an optional port isn't wired.
    template <class T>
    std::shared_ptr<const T> wish(const char* port) const {
        return wired(port) ? std::get<std::shared_ptr<const T>>(*wires(port).front()) : nullptr;
    }
    std::span<const NodeValue* const> wires(const char* port) const;
    const GraphTime& time() const { return given_.time; }
    const LoopPass& pass() const { return given_.pass ? *given_.pass : kOnly; }
    // What the repeated input gives in this pass; it lives as long as the node's evaluation.
    Result<const NodeValue*> makePass(const LoopPass& pass) const { return given_.makePass(pass); }
    bool passesRead(uint32_t output) const { return given_.passReads >> output & 1; }
    // What the node says of itself though it could be made.
    void note(std::string text) { note_ = std::move(text); }
    const std::string& noted() const { return note_; }
    // Of what the node is given that lies at these ports as constants; with `more` it says what a block is made from.
    static uint64_t key(std::initializer_list<uint64_t> more);

    // Room for planes of so many elements; the node's next block. `fresh`: its contents have to be made.
    struct Room {
        BlockRef block;
        bool fresh = true;
    };
    Result<Room> room(const char* name, uint64_t bytes, uint64_t madeFrom = 0);
    // Room that only what the node keeps refers to.
    Result<BlockRef> block(const char* name, uint64_t bytes) { return machine_.allocate(name, bytes); }
    Result<NodePlanes> planes(const char* name, uint32_t elements, uint32_t planeCount, BlockRef& into);
    // What the node kept by its last evaluation, of the type that it keeps; null: nothing. Who takes it gives it back
    // when all is listed, so that a node that fails keeps nothing that isn't so.
    template <class T>
    std::unique_ptr<T> takeMemory() {
        return std::unique_ptr<T>(static_cast<T*>(kept_.memory.release()));
    }
    void keep(std::unique_ptr<NodeMemory> memory) { kept_.memory = std::move(memory); }
    // Contents of the node's next block.
    template <class T>
    Result<Room> sent(const char* name, const std::vector<T>& values) {
        Result<Room> made = room(name, values.size() * sizeof(T));
        if (!made) return made;
        const auto bytes = std::as_bytes(std::span(values));
        list_.uploads.push_back({made->block, {bytes.begin(), bytes.end()}});
        return made;
    }
    // Places that the host has made, as planes in the node's next block.
    Result<NodePlanes> sentPlaces(const char* name, std::span<const glm::vec3> places, BlockRef& into);
    // A kernel over so many items.
    template <class Args>
    void run(const char* kernel, const Args& args, uint64_t items) {
        addNodeStage(list_, kernel, args, items);
    }
    void give(NodeValue value, size_t output = 0) { outputs_[output] = std::move(value); }
    std::vector<NodeValue>& outputs() { return outputs_; }

    // Geometry whose program has been gone through: positions that a kernel can read as they are. Fails where there are
    // instances. Its normals are those before the program, unless they are asked for.
    Result<GeometryPart> realised(const GeometryPart& part, bool normals = false);
    // Runs the kernels so far: for nodes that have very many. A failure of the device is the whole evaluation's.
    Status runNow();
    // What kernels so far leave in memory, read at once: for nodes whose counts follow from contents. Places as the
    // part's program leaves them, and words of its elements; without padding. They fail as runNow() does.
    Result<std::vector<glm::vec3>> placesNow(const GeometryPart& part);
    Result<std::vector<uint32_t>> wordsNow(const GeometryPart& part, const BlockRef& block);  // as readWords()
    // A mesh with all its instances as one: places, and corners three a triangle.
    struct WholeMesh {
        std::vector<glm::vec3> places;
        std::vector<uint32_t> corners;
    };
    Result<WholeMesh> wholeMeshNow(const GeometryPart& mesh);
    Result<NodeFile> file(const char* port) const {
        if (!given_.files) return Failure("", "this graph can't read files");
        return given_.files(given_.graphFile, text(port));
    }
    // The first part of that kind.
    Result<const GeometryPart*> part(const char* port, GeometryPart::Kind kind) const;

  private:
    Result<GeometryPart> deformed(const GeometryPart& part, bool normals = false);

    static constexpr LoopPass kOnly{};

    Given given_;
    NodeMachine& machine_;
    NodeKept& kept_;
    NodeWorkList& list_;
    std::vector<NodeValue> outputs_;
    size_t nextSlot_ = 0;
    std::string note_;
};

}  // namespace espalier
