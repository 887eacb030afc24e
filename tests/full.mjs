// Whether this is the full run, `npm run test:full`, which has more meshes, engines and programs than `npm test`.

export const full = process.env.EDGEFLIP_FULL === '1';
