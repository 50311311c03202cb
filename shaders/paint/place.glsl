// Where this invocation's texel lies. Included after `env` is declared.
vec3 worldPosition(vec3 p) {
    return vec3(dot3(env.toWorld[0].xyz, p) + env.toWorld[0].w, dot3(env.toWorld[1].xyz, p) + env.toWorld[1].w,
                dot3(env.toWorld[2].xyz, p) + env.toWorld[2].w);
}
vec3 worldNormal(uint packed) {
    vec3 n = unpackOct(packed);
    return vec3(dot3(env.toWorld[0].xyz, n), dot3(env.toWorld[1].xyz, n), dot3(env.toWorld[2].xyz, n)) * env.perScale;
}
