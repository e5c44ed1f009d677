// Sums over passes. The same bits come out wherever and in whatever parts they are computed: only sums and products of
// numbers that the host gives, kept from being contracted.

vec3 beautyOf(Sample s) {
    precise vec3 beauty = vec3(0.0);
    for (uint layer = 0u; layer < LAYER_COUNT; layer++) beauty += s.layers[layer];
    return beauty;
}

Sample add(Sample a, Sample b) {
    for (uint layer = 0u; layer < LAYER_COUNT; layer++) a.layers[layer] += b.layers[layer];
    a.albedo += b.albedo;
    a.normal += b.normal;
    a.depth += b.depth;
    a.covered += b.covered;
    return a;
}

// The sums of two runs of m and n passes together; perA = 1 / m, perB = 1 / n, weight = m n / (m + n)
// (Chan, Golub & LeVeque 1979, eq. 2.1b).
PixelSum join(PixelSum a, PixelSum b, float perA, float perB, float weight) {
    precise vec3 apart = beautyOf(a.sum) * perA - beautyOf(b.sum) * perB;
    precise vec3 deviation = a.deviation + b.deviation + apart * apart * weight;
    return PixelSum(add(a.sum, b.sum), deviation);
}
