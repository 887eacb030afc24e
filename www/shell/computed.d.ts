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
    /** The part of a page of the site that has the record. */
    source: string;
  };
  export default recorded;
}

declare module 'virtual:package' {
  const facts: {
    snippets: import('../package/tabs.ts').Snippet[];
    /** Whole kilobytes after gzip, by module or entry. */
    kilobytes: Record<string, number>;
    /** The oldest browsers. */
    browsers: string;
    addresses: { repository?: string; homepage?: string };
    /** What to say as long as there are none. */
    notPublic?: string;
  };
  export default facts;
}
