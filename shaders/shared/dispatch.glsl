// The item of this invocation in Pass::dispatchItems, which spreads groups over y beyond 65,535. Check it against
// the number of items: the last groups overhang.
#ifndef ESPALIER_SHARED_DISPATCH_GLSL
#define ESPALIER_SHARED_DISPATCH_GLSL

// A macro, because gl_WorkGroupSize in a function that stands before the layout(local_size_x) is taken as 1.
#define itemIndex() \
    ((gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x)

#endif
