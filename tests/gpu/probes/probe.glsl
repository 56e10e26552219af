// What every probe shares: one thread per input. The probe declares Input and Output and defines probe().
#extension GL_EXT_scalar_block_layout : require
#define PROBE(In, Out)                  \
    layout(local_size_x = 64) in;       \
    PARAMS(uint)                        \
    BUFFER(readonly, 0, In, inputs)     \
    BUFFER(writeonly, 1, Out, outputs)  \
    Out probe(In x);                    \
    void main() {                       \
        if (gl_GlobalInvocationID.x < params) outputs[gl_GlobalInvocationID.x] = probe(inputs[gl_GlobalInvocationID.x]); \
    }
