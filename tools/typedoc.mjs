// How TypeDoc documents the npm package, for `npm run docs` and for the page.

/** The arguments of Node that write the API reference into a folder. TypeDoc empties it first. A warning is an error. */
export const typedocTo = (folder, ...more) => [
  'node_modules/typedoc/bin/typedoc',
  ...['--name', 'edgeflip', '--out', folder, '--tsconfig', 'src/js/tsconfig.json'],
  ...['index', 'inline', 'worker', 'files', 'points', 'three', 'gltf-transform'].flatMap((entry) => [
    '--entryPoints',
    `src/js/${entry}.ts`,
  ]),
  ...['--readme', 'none', '--disableSources', '--excludePrivate', '--treatWarningsAsErrors'],
  ...['--intentionallyNotExported', 'CODES'],
  '--useFirstParagraphOfCommentAsSummary',
  '--skipErrorChecking', // only a build writes the types of the modules
  ...more,
];
