/** Modules that the build computes: see `vite.config.js`. */

declare module 'virtual:recorded' {
  /** A recorded run of a hardware GPU in Chromium. */
  const recorded: {
    device: string;
    /** Cores of the CPU beside it. */
    cores: number;
    browser: string;
    date: string;
    /** How many runs each time is the median of. */
    runs: number;
    meshes: { spec: string; triangles: number; ms: Record<'cpu' | 'webgpu' | 'webgl2', number> }[];
    /** The page of the site that has the record. */
    source: string;
  };
  export default recorded;
}

declare module 'virtual:package' {
  const facts: {
    snippets: { name: string; install?: string; code: string; source: string; page: string }[];
    /** Kilobytes after gzip, by module or entry. */
    kilobytes: Record<string, number>;
    /** The oldest browsers. */
    browsers: string;
    addresses: { repository?: string; homepage?: string };
  };
  export default facts;
}
