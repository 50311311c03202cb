#pragma once

// Graphs of tests: from a text to what they make.

#include <doctest/doctest.h>

#include <chrono>
#include <string>

#include "runtime/core/file.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/nodes/evaluation.hpp"

namespace espalier::nodetest {

inline NodeGraph parsed(const std::string& text) {
    Result<NodeGraph> graph = parseGraph(text, "test.graph");
    INFO((graph ? std::string() : graph.failure().text()));
    REQUIRE(graph);
    return std::move(*graph);
}

// Chance comes from this hash, which oracles work out once more.
inline uint32_t mixed(uint32_t x) {
    x ^= x >> 16;
    x *= 0x7FEB352D;
    x ^= x >> 15;
    x *= 0x846CA68B;
    return x ^ x >> 16;
}

// The message of a text that can't be used.
inline std::string mistakesIn(const std::string& text) {
    Result<NodeGraph> graph = parseGraph(text, "test.graph");
    if (!graph) return graph.failure().text();
    Result<CheckedGraph> checked = checkGraph(*graph);
    return checked ? std::string() : checked.failure().text();
}

inline NodeEvaluation evaluationOf(const std::string& text, std::unique_ptr<NodeMachine> machine = hostMachine(1)) {
    NodeEvaluation evaluation(std::move(machine));
    const Status loaded = evaluation.load(parsed(text));
    INFO((loaded ? std::string() : loaded.failure().text()));
    REQUIRE(loaded);
    REQUIRE(evaluation.evaluate());
    return evaluation;
}

inline Geometry geometryOf(NodeEvaluation& evaluation, const char* node) {
    Result<const NodeValue*> value = evaluation.inspect(node);
    REQUIRE(value);
    REQUIRE(value.value());
    return std::get<Geometry>(*value.value());
}

inline std::string contentText(const std::string& name) {
    Result<std::vector<std::byte>> file = readFile("content/graphs/" + name);
    REQUIRE(file);
    return {reinterpret_cast<const char*>(file->data()), file->size()};
}

// Of all that a graph shows: places, normals and corners, bit by bit.
inline uint64_t hashOf(NodeEvaluation& evaluation) {
    uint64_t hash = 0;
    const auto add = [&](const auto& list) { hash = hashBytes(std::as_bytes(std::span(list)), hash); };
    for (const GeometryPart& part : evaluation.shown()) {
        add(*evaluation.positions(part));
        add(*evaluation.normals(part));
        add(*evaluation.corners(part));
    }
    return hash;
}

// The machine of tests, with the room that is asked of it.
class CountingMachine : public NodeMachine {
  public:
    explicit CountingMachine(uint64_t& bytes) : bytes_(bytes), inner_(hostMachine(1)) {}
    Result<BlockRef> allocate(const char* name, uint64_t bytes) override {
        bytes_ += bytes;
        return inner_->allocate(name, bytes);
    }
    Status run(NodeWorkList list) override { return inner_->run(std::move(list)); }
    Result<std::vector<std::byte>> read(const NodeBlock& block, uint64_t bytes) override {
        return inner_->read(block, bytes);
    }

  private:
    uint64_t& bytes_;
    std::unique_ptr<NodeMachine> inner_;
};

template <class Work>
double secondsOf(const Work& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace espalier::nodetest
