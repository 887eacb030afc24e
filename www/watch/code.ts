/** The lines of JavaScript that do what is on screen. */

import type { Shown } from './shown.ts';

export function codeFor({ opened, run, settings }: Shown): string {
  const { mesh, spec, name, drawn } = opened;
  const { backend, maxNormalAngle, maxDeviation, features, keepsGroups } = settings;
  const isSurface = mesh.dimension === 3;
  const has = (key: string) => key in mesh && mesh[key as keyof typeof mesh] !== undefined;
  const options = [
    ...(backend === 'auto' ? [] : [`backend: '${backend}'`]),
    ...(isSurface ? [`maxNormalAngle: ${maxNormalAngle}`] : []),
    ...(isSurface && maxDeviation !== undefined ? [`maxDeviation: ${maxDeviation}`] : []),
    ...(run.isOver ? [] : [`maxIterations: ${run.at}`]),
    ...(has('groups') && keepsGroups ? ['groups: mesh.groups'] : []),
    ...(drawn.length > 0 ? [`constraints: [${drawn.join(', ')}]`] : []),
    ...(has('lockedEdges') && drawn.length === 0 ? ['lockedEdges: mesh.lockedEdges'] : []),
  ];
  const isGenerated = spec !== undefined && !spec.includes('/');
  return [
    `import { makeDelaunay } from 'edgeflip';`,
    `import { ${isGenerated ? 'generate' : 'readMesh'} } from 'edgeflip/files';`,
    '',
    isGenerated ? `const mesh = await generate('${spec}');` : `const mesh = await readMesh(bytes, '${name}');`,
    ...(isSurface && features !== undefined
      ? [`// The page also locks edges that bend by more than ${features}°.`]
      : []),
    `const { indices } = await makeDelaunay(mesh, { ${options.join(', ')} });`,
    '',
  ].join('\n');
}
