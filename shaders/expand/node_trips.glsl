// Passes over nodes take them in blocks: a group's nodes follow each other, and leaves near each other lie on nodes near
// each other.
uint nodeOfTrip(uint k) {
    const uint each = kNodesPerGroup / kExpandGroup;
    uint block = (k / each) * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    return block * kNodesPerGroup + (k % each) * kExpandGroup + gl_LocalInvocationID.x;
}
