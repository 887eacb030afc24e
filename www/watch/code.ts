/** The lines of JavaScript that do what is on screen. They run as they stand. */

import { BROUGHT } from '../models/samples.js';
import type { Opened } from './opening.ts';
import { widthOf } from './plan.ts';
import type { Shown } from './shown.ts';
import { splitName } from './sources.ts';

export function codeFor({ opened, run, settings }: Shown): string {
  const { mesh, drawn, origin } = opened;
  const { backend, maxNormalAngle, maxDeviation, features, keepsGroups } = settings;
  const isSurface = mesh.dimension === 3;
  const locksFeatures = isSurface && features !== undefined;
  const isGenerated = origin !== undefined && !origin.startsWith(BROUGHT) && !opened.isScrambled;
  const has = (key: string) => !isGenerated && key in mesh && mesh[key as keyof typeof mesh] !== undefined;
  const locked = has('lockedEdges') ? 'mesh.lockedEdges' : undefined;
  const options = [
    ...(backend === 'auto' ? [] : [`backend: '${backend}'`]),
    ...(isSurface ? [`maxNormalAngle: ${maxNormalAngle}`] : []),
    ...(isSurface && maxDeviation !== undefined ? [`maxDeviation: ${maxDeviation}`] : []),
    ...(run.isOver || run.at === 0 ? [] : [`maxIterations: ${run.at}`]),
    ...(has('groups') && keepsGroups ? ['groups: mesh.groups'] : []),
    ...(drawn.length > 0 ? [`constraints: [${drawn.join(', ')}]`] : []),
    ...(locksFeatures
      ? [locked ? `lockedEdges: [...${locked}, ...sharp]` : 'lockedEdges: sharp']
      : locked
        ? [`lockedEdges: ${locked}`]
        : []),
    ...(has('lockedTriangles') ? ['lockedTriangles: mesh.lockedTriangles'] : []),
  ];
  const arePoints = !opened.isScrambled && 'isTriangulated' in mesh;
  return [
    `import { ${locksFeatures ? 'FlipSession, ' : ''}makeDelaunay } from 'edgeflip';`,
    `import { ${isGenerated ? 'generate' : 'readMesh'} } from 'edgeflip/files';`,
    ...(arePoints ? [`import { triangulate } from 'edgeflip/points';`] : []),
    '',
    ...(isGenerated ? [`const mesh = await generate(${quoted(origin)});`] : linesOfReading(opened)),
    ...(arePoints
      ? [
          `const { triangles } = await triangulate(mesh.positions, { stride: ${widthOf(mesh)} });`,
          'mesh.indices = triangles;',
        ]
      : []),
    ...(locksFeatures ? linesOfFeatures(features) : []),
    `const { indices } = await makeDelaunay(mesh${options.length > 0 ? `, { ${options.join(', ')} }` : ''});`,
    '',
  ].join('\n');
}

const quoted = (text: string) => `'${text.replaceAll(/[\\']/g, '\\$&')}'`;

/** The lines that read the file: of the page, or one that the visitor has. */
function linesOfReading(opened: Opened): string[] {
  const { origin, kept, isScrambled, mesh } = opened;
  const [stem, extension] = splitName(opened.name);
  const ofPage = isScrambled || !origin?.startsWith(BROUGHT) ? undefined : new URL(origin, document.baseURI).href;
  const name = isScrambled ? `${stem.replaceAll(' ', '-')}-after-0${extension}` : opened.name;
  const beside = isScrambled ? [] : [...(kept?.beside.keys() ?? [])];
  const files = beside.map(
    (other) => `${quoted(other)}: await load(${quoted(other.split('/').map(encodeURIComponent).join('/'))})`,
  );
  const options = [
    ...(files.length > 0 ? [`files: { ${files.join(', ')} }`] : []),
    ...(mesh.plane ? [`plane: '${mesh.plane}'`] : []),
  ];
  return [
    'const load = async (url) => new Uint8Array(await (await fetch(url)).arrayBuffer());',
    ...(isScrambled
      ? ['// The page flipped its edges at random. Go back to the input, save it, and put the file beside this page.']
      : ofPage
        ? []
        : ['// The file is beside this page.']),
    `const bytes = await load(${quoted(ofPage ?? encodeURIComponent(name))});`,
    `const mesh = await readMesh(bytes, ${quoted(name)}${options.length > 0 ? `, { ${options.join(', ')} }` : ''});`,
  ];
}

/** The lines that find the sharp edges, as `features.ts` does. */
const linesOfFeatures = (degrees: number) => [
  '',
  `// The edges at which the surface bends by more than ${degrees}°.`,
  `const session = await FlipSession.create(mesh, { backend: 'cpu' });`,
  'const { v1, v2, ta, tb } = await session.edges();',
  'session.free();',
  'const normal = (half) => {',
  '  const [p, q, r] = [0, 1, 2].map((k) => 3 * mesh.indices[half - (half % 3) + k]);',
  '  const [a, b, c] = [0, 1, 2].map((k) => mesh.positions[q + k] - mesh.positions[p + k]);',
  '  const [d, e, f] = [0, 1, 2].map((k) => mesh.positions[r + k] - mesh.positions[p + k]);',
  '  return [b * f - c * e, c * d - a * f, a * e - b * d];',
  '};',
  `const least = Math.cos((${degrees} * Math.PI) / 180);`,
  'const isSharp = (edge) => {',
  '  if (tb[edge] === 0xffffffff) return false;',
  '  const [u, v] = [normal(ta[edge]), normal(tb[edge])];',
  '  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2] < least * Math.hypot(...u) * Math.hypot(...v);',
  '};',
  'const sharp = [...v1.keys()].filter(isSharp).flatMap((edge) => [v1[edge], v2[edge]]);',
  '',
];
